"""Logs of text as people have them, each from its campaign file to the samples."""

from pathlib import Path

import chain
import numpy as np
import pandas as pd
import pytest

from inertial.tables.errors import Refusal

CAMPAIGN = """\
campaign: 1
instrument: {{name: some IMU}}
serial: unknown
date: unknown
site: {{latitude_deg: null, gravity_m_s2: 9.81, gravity_sigma_m_s2: 0.01}}
table: {{name: by hand, position_sigma_arcsec: 3600}}
log: {log}
formats:
  log: {format}
plan:
  - {{id: all, do: positions, seconds: 3, format: log}}
"""
AXES = (
    "accelerometer: {columns: [ax, ay, az], unit: m/s2}, gyro: {columns: [gx, gy, gz], unit: rad/s}"
)
NUMBERED = (
    "accelerometer: {columns: [2, 3, 4], unit: m/s2}, gyro: {columns: [5, 6, 7], unit: rad/s}"
)
VALUES = "1,2,3,4,5,6"


@pytest.fixture
def decoded(tmp_path):
    """The tables of decode for a log with this content, or a recorded one, in this format."""

    def run(log: bytes | Path, layout: str) -> chain.Results:
        folder = tmp_path / "campaign"
        folder.mkdir()
        name = "log.csv"
        (folder / name).write_bytes(log if isinstance(log, bytes) else log.read_bytes())
        text = CAMPAIGN.format(log=name, format=layout)
        (folder / "campaign.yaml").write_text(text, encoding="utf-8")
        return chain.run(folder, tmp_path / "derived", "decode")

    return run


def lines(results: chain.Results) -> dict[str, int]:
    """How many lines of the log are of each kind."""
    accounts = results["decode/accounts"]
    return dict(accounts.groupby("kind")["lines"].sum())


def rows(stamps: list[str], between: str = ",") -> bytes:
    """A row for each stamp, with the six numbers of VALUES."""
    return "".join(f"{t},{VALUES}\n".replace(",", between) for t in stamps).encode()


# ---- stamps


def test_nanoseconds_keep_their_last_digit(decoded):
    first = 1403636579758555393  # a floating-point number would hold it to 256 ns
    stamps = [str(first + n * 5_000_001) for n in range(50)]
    header = b"#timestamp [ns],ax,ay,az,gx,gy,gz\n"
    layout = f"{{kind: columns, delimiter: ',', header_lines: 1, {AXES}, "
    results = decoded(header + rows(stamps), layout + "time: {column: 'timestamp [ns]', unit: ns}}")
    time = results["decode/samples"]["time"].to_numpy()
    np.testing.assert_allclose(time, np.arange(50) * 5.000001e-3, rtol=0, atol=1e-15)
    assert lines(results) == {"decoded": 50, "header": 1}


def test_nanoseconds_with_an_exponent_are_those_of_their_digits(decoded):
    stamps = ["1.40363657975856E+018", "1.40363657976356e18", "1403636579768560000", "none", "1e40"]
    layout = f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {{column: 1, unit: ns}}}}"
    results = decoded(rows(stamps), layout)
    np.testing.assert_allclose(results["decode/samples"]["time"], [0, 5e-3, 10e-3], atol=1e-15)
    reasons = results["decode/refused"]["reason"].tolist()
    assert reasons == [f"column 1 is '{text}', expected nanoseconds" for text in stamps[3:]]


ISO = {  # by hand, in s after the first
    "2026-03-01T00:59:59.995Z": 0.0,
    "2026-03-01T01:00:00": 0.005,
    "2026-03-01 01:00:00.010000": 0.015,
    "2026-03-01T02:00:00.015+01:00": 0.020,
    "2026-02-28T20:00:00.020-0500": 0.025,
    "2026-03-01T01:00:00.025000001Z": 0.030000001,
}


def test_dates_with_the_time_of_the_day(decoded):
    layout = f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {{column: 1, unit: iso8601}}}}"
    results = decoded(rows(list(ISO)), layout)
    np.testing.assert_allclose(results["decode/samples"]["time"], list(ISO.values()), atol=1e-12)


def test_a_date_that_is_none_costs_its_row_and_no_other(decoded):
    stamps = [*list(ISO)[:5], "2026-02-30T00:00:00Z", "20260301T010000,030Z", "1772326800"]
    layout = f"{{kind: columns, delimiter: ;, {NUMBERED}, time: {{column: 1, unit: iso8601}}}}"
    log = "".join(f"{stamp};{VALUES.replace(',', ';')}\n" for stamp in stamps)
    results = decoded(log.encode(), layout)
    times = [*list(ISO.values())[:5], 0.035]
    np.testing.assert_allclose(results["decode/samples"]["time"], times, atol=1e-9)
    reasons = results["decode/refused"].set_index("line")["reason"]
    assert list(reasons.index) == [6, 8]
    assert reasons[8].startswith("column 1 is '1772326800', expected a time such as 2026-")


@pytest.mark.parametrize(
    "stamps",
    [
        ["28.02.2026 23:59:59.5", "1.3.2026 00:00:00.5", "01.03.2026 12:30:00"],
        ["2/28/2026 11:59:59.5 PM", "03/01/2026 12:00:00.5 AM", "3/1/2026 12:30:00 pm"],
    ],
)
def test_dates_with_the_day_or_the_month_first(stamps, decoded):
    """Half a second before midnight, half a second behind it, and half past noon."""
    layout = f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {{column: 1, unit: iso8601}}}}"
    results = decoded(rows(stamps), layout)
    np.testing.assert_allclose(results["decode/samples"]["time"], [0.0, 1.0, 45_000.5], atol=1e-9)


@pytest.mark.parametrize(
    ("stamps", "seconds"),
    [
        (
            ["23:59:59.5", "00:00:00.5", "00:00:01", "23:59:59", "00:00:00"],
            [0, 1, 1.5, 86_399.5, 86_400.5],
        ),
        # Less than half a day back is no midnight, and a date goes on by itself.
        (["12:00:01", "12:00:00", "12:00:02"], [0, -1, 1]),
        (["2026-03-02T23:00:00", "2026-03-02T01:00:00"], [0, -79_200]),
    ],
)
def test_the_time_of_the_day_goes_on_over_midnight(stamps, seconds, decoded):
    layout = f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {{column: 1, unit: iso8601}}}}"
    time = decoded(rows(stamps), layout)["decode/samples"]["time"]
    np.testing.assert_allclose(time, seconds, atol=1e-9)


def test_seconds_since_1970_are_counted_from_the_first(decoded):
    stamps = [f"{1535630275.916451 + n * 0.01:.6f}" for n in range(5)]
    layout = f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {{column: 1, unit: s}}}}"
    time = decoded(rows(stamps), layout)["decode/samples"]["time"]
    np.testing.assert_allclose(time, np.arange(5) * 0.01, atol=5e-7)


XSENS = b"""\
// Start Time: Unknown
// Update Rate: 100.0Hz
// Filter Profile: human (46.1)
PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z
"""
OF_XSENS = (
    '{kind: columns, delimiter: "\\t", comment: //, header_lines: 1, '
    "accelerometer: {columns: [Acc_X, Acc_Y, Acc_Z], unit: m/s2}, "
    "gyro: {columns: [Gyr_X, Gyr_Y, Gyr_Z], unit: rad/s}, time: "
)


@pytest.mark.parametrize(
    "time",
    [
        "{column: PacketCounter, unit: sample, rate_hz: 100, wraps_at: 65536}}",
        "{column: SampleTimeFine, unit: tick, ticks_per_s: 10000, wraps_at: 4294967296}}",
    ],
)
def test_counters_of_an_xsens_export_go_on_where_they_begin_again(decoded, time):
    """Both begin again in the middle; 10 ms are one packet or 100 ticks of 100 µs."""
    number = np.arange(60)
    packet, tick = (65530 + number) % 2**16, (2**32 - 2950 + 100 * number) % 2**32
    assert packet[6] == 0 and tick[30] == 50
    log = XSENS
    for n in number[number != 40].tolist():  # one is lost
        log += f"{packet[n]:05d}\t{tick[n]}\t0.1\t0.2\t9.8\t0.01\t0.02\t0.03\n".encode()
    results = decoded(log, OF_XSENS + time)
    found = results["decode/samples"]["time"].to_numpy()
    np.testing.assert_allclose(found, number[number != 40] / 100, atol=1e-9)
    assert lines(results) == {"decoded": 59, "header": 4}
    assert results["decode/clocks"]["interval"][0] == pytest.approx(0.01)


def test_more_samples_a_second_than_an_imu_takes_are_of_a_wrong_unit(decoded):
    """The count size of the accelerometers was blamed for it."""
    log = b"t,ax,ay,az,gx,gy,gz\n" + rows([f"{n / 100:.2f}" for n in range(50)])
    layout = f"{{kind: columns, delimiter: ',', header_lines: 1, {AXES}, "
    with pytest.raises(Refusal, match=r"time\n.*100.* samples a second.*in ms") as refusal:
        decoded(log, layout + "time: {column: t, unit: ms}}")
    assert "correct the unit of the time" in refusal.value.cure


def test_the_names_stand_above_a_line_of_units(decoded):
    head = b"Logger 3\nt,az,ay,ax,gx,gy,gz\ns,m/s2,m/s2,m/s2,rad/s,rad/s,rad/s\n"
    layout = f"{{kind: columns, delimiter: ',', header_lines: 3, {AXES}, "
    results = decoded(head + rows(["0.00", "0.01"]), layout + "time: {column: t, unit: s}}")
    assert results["decode/samples"]["accel_x"].tolist() == [3, 3]
    assert results["decode/samples"]["accel_z"].tolist() == [1, 1]


def test_two_carriage_returns_end_a_line_and_a_blank_line_follows_the_names(decoded):
    """As csv of Python writes them on Windows; all rows were refused."""
    text = b"t,ax,ay,az,gx,gy,gz\n\n" + rows(["0.00", "0.01", "0.02"])
    layout = f"{{kind: columns, delimiter: ',', header_lines: 2, {AXES}, "
    results = decoded(text.replace(b"\n", b"\r\r\n"), layout + "time: {column: t, unit: s}}")
    assert results["decode/samples"]["accel_z"].tolist() == [3, 3, 3]
    assert results["decode/accounts"]["bytes"].sum() == len(text) + 2 * text.count(b"\n")


def test_a_binary_file_is_no_text_whose_names_are_listed(decoded):
    layout = f"{{kind: columns, delimiter: ',', header_lines: 1, {AXES}}}"
    log = np.random.default_rng(0).bytes(100_000)
    with pytest.raises(Refusal, match="is no text") as refusal:
        decoded(log, layout.replace("}}", "}, time: {rate_hz: 100}}"))
    assert "export the log as text" in refusal.value.cure and str(refusal.value).isascii()


# ---- numbers and what separates them


@pytest.mark.parametrize(("name", "between"), [('";"', ";"), ('"\\t"', "\t"), ('" "', " ")])
def test_a_decimal_comma(decoded, name, between):
    header = between.join(["t", "ax", "ay", "az", "gx", "gy", "gz"])
    log = f"{header}\n"
    for n in range(4):
        log += between.join([f"0,{n}5", "-1,25", "2", "9,81", "1,5e-3", "0", ",5"]) + "\n"
    log += between.join(["0,45", "-1.25", "2", "9,81", "0", "0", "0"]) + "\n"
    layout = f"{{kind: columns, delimiter: {name}, decimal: ',', header_lines: 1, {AXES}, "
    results = decoded(log.encode(), layout + "time: {column: t, unit: s}}")
    samples = results["decode/samples"]
    np.testing.assert_allclose(samples["time"], [0, 0.1, 0.2, 0.3], atol=1e-12)
    found = samples[["accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y", "gyro_z"]].to_numpy()
    np.testing.assert_array_equal(found, [[-1.25, 2, 9.81, 1.5e-3, 0, 0.5]] * 4)
    assert results["decode/refused"]["reason"].tolist() == [
        "column ax is '-1.25', expected a finite number"
    ]


def test_a_comma_for_both_is_refused(decoded):
    layout = f"{{kind: columns, delimiter: ',', decimal: ',', {NUMBERED}, time: {{rate_hz: 100}}}}"
    with pytest.raises(Refusal, match=r"formats\.log\.decimal") as refusal:
        decoded(rows(["0"]), layout)
    assert "another character than the delimiter" in str(refusal.value)


@pytest.mark.parametrize(
    ("time", "key"),
    [
        ("{column: 1}", "unit"),
        ("{column: 1, unit: sample}", "rate_hz"),
        ("{column: 1, unit: tick}", "ticks_per_s"),
    ],
)
def test_a_time_without_its_unit_is_refused(decoded, time, key):
    with pytest.raises(Refusal, match=rf"formats\.log\.time.*\n.*no key '{key}'"):
        decoded(rows(["0"]), f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {time}}}")


def test_an_unknown_unit_is_refused_with_those_that_exist(decoded):
    layout = f"{{kind: columns, delimiter: ',', {NUMBERED}, time: {{column: 1, unit: min}}}}"
    with pytest.raises(Refusal) as refusal:
        decoded(rows(["0"]), layout)
    assert "'min'" in str(refusal.value)
    for unit in ("s", "ms", "us", "ns", "iso8601", "tick", "sample"):
        assert f"'{unit}'" in str(refusal.value)


# ---- lines that are no rows, fields that are none


def test_comments_are_header_wherever_they_stand(decoded):
    log = b"# made by a logger\n#t ax ay az gx gy gz\n"
    log += b"0 1 2 3 4 5 6\n# put down 1 2 3 4\n1 1 2 3 4 5 6\n"
    layout = f"{{kind: columns, comment: '#', {AXES}, time: {{column: t, unit: s}}}}"
    results = decoded(log, layout)
    assert lines(results) == {"decoded": 2, "header": 3}
    samples = results["decode/samples"]
    assert samples["record"].tolist() == [0, 1]
    assert samples["line"].tolist() == [3, 5]
    assert samples["offset"].tolist() == [40, 73]


def test_rows_that_end_with_a_delimiter(decoded):
    header = b"SESSION\n\nt,ax,ay,az,gx,gy,gz\n"
    layout = f"{{kind: columns, delimiter: ',', header_lines: 3, {AXES}, "
    log = header + rows(["0", "1"]).replace(b"\n", b",\n") + b"2," + VALUES.encode() + b"\n"
    results = decoded(log, layout + "time: {column: t, unit: s}}")
    assert results["decode/samples"]["time"].tolist() == [0, 1]
    assert results["decode/refused"]["reason"].tolist() == ["7 fields, expected 8"]


def test_a_sensor_that_stands_blank_is_not_recorded_there(decoded):
    """As where logs of several rates were joined into one table."""
    log = b"t,ax,ay,az,gx,gy,gz\n0,1,2,3,4,5,6\n1,,,,4,5,6\n2,,,,,,\n3,1,2,,4,5,6\n"
    layout = f"{{kind: columns, delimiter: ',', header_lines: 1, {AXES}, "
    results = decoded(log, layout + "time: {column: t, unit: s}}")
    samples = results["decode/samples"]
    assert samples["time"].tolist() == [0, 1]
    assert samples["accel_x"].isna().tolist() == [False, True]
    assert samples["gyro_z"].tolist() == [6, 6]
    assert lines(results) == {"decoded": 2, "header": 1, "not selected": 1, "refused": 1}
    assert results["decode/refused"]["reason"][0].startswith("column az is ''")


@pytest.mark.parametrize(
    "header", ['"t","ax","ay","az","gx, raw"', 't, "ax", "ay", "az","gx, raw",']
)
def test_names_in_quotes_as_other_programs_write_them(decoded, header):
    """R's write.csv does, by RFC 4180; a name may hold the delimiter."""
    layout = (
        "{kind: columns, delimiter: ',', header_lines: 1, time: {column: t, unit: s}, "
        "accelerometer: {columns: [ax, ay, az], unit: m/s2}, "
        "gyro: {columns: ['gx, raw', ~, ~], unit: rad/s}}"
    )
    results = decoded(header.encode() + b"\n0,1,2,3,4\n1,5,6,7,8\n", layout)
    assert results["decode/samples"]["accel_y"].tolist() == [2, 6]
    assert results["decode/samples"]["gyro_x"].tolist() == [4, 8]


def test_a_header_in_the_code_page_of_windows(decoded):
    header = "t,ax,ay,az,gx [°/s],gy [°/s],gz [°/s]\n".encode("cp1252")
    layout = (
        "{kind: columns, delimiter: ',', header_lines: 1, time: {column: t, unit: s}, "
        "gyro: {columns: ['gx [°/s]', 'gy [°/s]', 'gz [°/s]'], unit: deg/s}}"
    )
    results = decoded(header + rows(["0", "1"]), layout)
    np.testing.assert_allclose(results["decode/samples"]["gyro_x"], np.radians([4, 4]))


# ---- VectorNav

# As a sensor sent it: published in code that reads the VN-200.
SENT = (
    b"$VNIMU,-00.0350,+00.4222,-00.6643,-00.015,+00.019,+09.948,"
    b"+00.002066,-00.008442,-00.044656,+20.7,+084.322*66\r\n"
)
VECTORNAV = "{kind: vectornav, time: {rate_hz: 40}}"


def with_crc(line: bytes) -> bytes:
    """The same message with a CRC-16, CCITT from 0, bit by bit."""
    body, crc = line.partition(b"*")[0][1:], 0
    for byte in body:
        crc ^= byte << 8
        for _bit in range(8):
            crc = crc << 1 ^ (0x1021 if crc & 0x8000 else 0)
        crc &= 0xFFFF
    return b"$%s*%04X\r\n" % (body, crc)


@pytest.mark.parametrize("line", [SENT, with_crc(SENT)])
def test_vectornav_reads_what_the_sensor_sent(decoded, line):
    results = decoded(line * 3, VECTORNAV)
    samples = results["decode/samples"]
    assert samples["time"].tolist() == [0, 0.025, 0.05]
    first = samples.iloc[0]
    assert first[["accel_x", "accel_y", "accel_z"]].tolist() == [-0.015, 0.019, 9.948]
    assert first[["gyro_x", "gyro_y", "gyro_z"]].tolist() == [0.002066, -0.008442, -0.044656]
    assert first["temperature"] == pytest.approx(273.15 + 20.7)


def test_vectornav_refuses_damaged_lines_and_keeps_their_place(decoded):
    wrong = SENT.replace(b"+09.948", b"+09.949")  # the last digit: the checksum becomes 67
    answer = b"$VNRRG,8*4B\r\n"  # published in the manual
    log = (
        answer + SENT + wrong + answer + b"\r\n" + SENT + SENT[:40] + SENT + b"84.322*66\r\n" + SENT
    )
    results = decoded(log, VECTORNAV)
    samples = results["decode/samples"]
    assert samples["record"].tolist() == [0, 2, 4]
    assert samples["time"].tolist() == [0, 0.05, 0.1]
    assert samples["line"].tolist() == [2, 6, 9]
    refused = results["decode/refused"]
    assert refused["line"].tolist() == [3, 7, 8]
    damaged, glued, end = refused["reason"]
    assert damaged == "checksum '66', computed '67'"
    assert glued.startswith("checksum '66', computed")
    assert end == "no message, expected '$' at the beginning"
    accounts = results["decode/accounts"]
    assert accounts["bytes"].sum() == len(log)
    others = accounts[accounts["kind"] == "other message"]
    assert others[["name", "lines"]].to_numpy().tolist() == [["VNRRG", 2]]


def test_vectornav_without_raw_readings_is_refused(decoded):
    with pytest.raises(Refusal, match=r"no \$VNIMU, but 3 VNRRG"):
        decoded(b"$VNRRG,8*4B\r\n" * 3, VECTORNAV)


# ---- as they were recorded


def test_euroc_log(decoded, recordings):
    layout = (
        "{kind: columns, delimiter: ',', header_lines: 1, "
        "time: {column: '#timestamp [ns]', unit: ns}, gyro: {unit: rad/s, columns: "
        "['w_RS_S_x [rad s^-1]', 'w_RS_S_y [rad s^-1]', 'w_RS_S_z [rad s^-1]']}, "
        "accelerometer: {unit: m/s2, columns: "
        "['a_RS_S_x [m s^-2]', 'a_RS_S_y [m s^-2]', 'a_RS_S_z [m s^-2]']}}"
    )
    results = decoded(recordings / "formats/euroc_imu0_head.csv", layout)
    samples = results["decode/samples"]
    assert lines(results) == {"decoded": 3999, "header": 1}
    np.testing.assert_allclose(np.diff(samples["time"]), 0.005, atol=1e-12)  # 200 Hz
    assert samples["accel_z"].iloc[0] == -2.40262925


def test_microstrain_log(decoded, recordings):
    layout = (
        "{kind: columns, delimiter: ',', header_lines: 16, time: {column: GPS TOW, unit: s}, "
        "accelerometer: {unit: g, columns: "
        "['X Accel [x8004]', 'Y Accel [x8004]', 'Z Accel [x8004]']}, "
        "gyro: {unit: rad/s, columns: ['X Gyro [x8005]', 'Y Gyro [x8005]', 'Z Gyro [x8005]']}}"
    )
    results = decoded(recordings / "formats/microstrain.csv", layout)
    samples = results["decode/samples"]
    assert lines(results) == {"decoded": 144, "header": 16}
    np.testing.assert_allclose(np.diff(samples["time"]), 0.01, atol=1e-6)
    assert samples["accel_z"].iloc[0] == pytest.approx(-1.00313628 * 9.80665)


def test_vectornav_log(decoded, recordings):
    results = decoded(recordings / "formats/vectornav_made.log", VECTORNAV)
    assert lines(results) == {"decoded": 200}
    assert results["decode/samples"]["accel_z"].iloc[0] == -9.769


def test_log_whose_header_is_a_comment(decoded, recordings):
    layout = (
        "{kind: columns, comment: '#', time: {column: time, unit: s}, "
        "accelerometer: {columns: [tx, ty, tz], unit: m/s2}, "
        "gyro: {columns: [wx, wy, wz], unit: rad/s}}"
    )
    results = decoded(recordings / "snu_multipos/imu_good1.txt", layout)
    assert lines(results) == {"decoded": 6566, "header": 1}
    assert isinstance(results["decode/samples"], pd.DataFrame)
