"""What is wrong with a recording, told without its plan."""

import zlib

import chain
import numpy as np
import pytest

RESTS = [
    {"id": "up", "do": "rest", "up": "+z", "seconds": 20, "log": "up.asc"},
    {"id": "down", "do": "rest", "up": "-z", "seconds": 20, "log": "down.asc"},
]


def two_rests(folder, change=lambda lines: lines, **replaced: str) -> chain.Results:
    """Two rests of 20 s; `change` alters the first log's lines, `replaced` the campaign file."""
    document = chain.demo()
    document["campaign"]["plan"] = RESTS
    campaign = chain.simulate(document, folder / "campaign")
    log = campaign / "up.asc"
    log.write_bytes(b"".join(change(log.read_bytes().splitlines(keepends=True))))
    file = campaign / "campaign.yaml"
    text = file.read_text()
    for right, wrong in replaced.items():
        assert right in text
        text = text.replace(right, wrong)
    file.write_text(text)
    return chain.run(campaign, folder / "derived", "segment")


def test_a_gap_is_counted_to_the_sample(tmp_path):
    results = two_rests(tmp_path, lambda lines: lines[:500] + lines[537:])
    finding = results["quality/findings"].iloc[0]
    assert (finding["cause"], finding["size"], finding["unit"]) == ("gap", 37, "samples")
    assert finding["to_s"] - finding["from_s"] == pytest.approx(0.38)
    assert "line 501" in finding["sentence"]


def test_a_repeated_record_is_named_and_masked(tmp_path):
    results = two_rests(tmp_path, lambda lines: lines[:700] + lines[699:])
    assert list(results["quality/findings"]["cause"]) == ["duplicate"]
    mask = results["quality/masks"].iloc[0]
    assert (mask["from_record"], mask["to_record"], mask["repeated"]) == (700, 701, True)
    counts = results["segment/blocks"].groupby("manoeuvre")["count"].sum()
    assert counts["up"] == counts["down"]  # 2001 records, with one of which no time passes


def test_a_record_that_is_held_is_masked_while_time_passes(tmp_path):
    def held(lines):
        return [
            line if number not in (901, 902) else signed(line, lines[900])
            for number, line in enumerate(lines)
        ]

    results = two_rests(tmp_path, held)
    assert list(results["quality/findings"]["cause"]) == ["held_record"]
    assert results["quality/findings"]["p_value"].iloc[0] < 1e-3
    mask = results["quality/masks"].iloc[0]
    assert (mask["from_record"], mask["to_record"], mask["repeated"]) == (901, 903, False)
    blocks = results["segment/blocks"]
    assert blocks[blocks["manoeuvre"] == "up"]["mask_share"].sum() > 0


def signed(line, of):
    """A line with its own stamp and the readings of another, and the checksum of both."""
    body = b",".join([*line[1:].split(b",")[:5], *of[1:].rpartition(b"*")[0].split(b",")[5:]])
    checksum = zlib.crc32(body, 0xFFFFFFFF) ^ 0xFFFFFFFF
    return b"%%%s*%08x\r\n" % (body, checksum)


def with_tail(lines, step):
    """The lines, and behind them as many with one reading in all channels, `step` s apart."""
    head, readings = lines[-1].rpartition(b"*")[0].split(b";")
    time, status = readings.split(b",")[1:3]
    tail = []
    for number in range(len(lines)):
        stamp = b"%.9f" % (float(time) + 0.01 + number * step)
        body = b";".join([head, b",".join([b"2443", stamp, status, *[b"1"] * 6])])[1:]
        checksum = zlib.crc32(body, 0xFFFFFFFF) ^ 0xFFFFFFFF
        tail.append(b"%%%s*%08x\r\n" % (body, checksum))
    return [*lines, *tail]


@pytest.mark.parametrize(("cause", "step"), [("duplicate", 0.0), ("held_record", 0.01)])
def test_a_tail_of_one_record_over_and_over_spoils_nothing_before_it(tmp_path, cause, step):
    """Most of a log may be erased memory: its noise and gravity are those of what was recorded."""

    results = two_rests(tmp_path, lambda lines: with_tail(lines, step))
    assert list(results["quality/findings"]["cause"]) == [cause]
    noise = results["quality/channel_statistics"].pivot(
        index=["sensor", "axis"], columns="log", values="noise"
    )
    assert noise["up.asc"].to_numpy() == pytest.approx(noise["down.asc"].to_numpy(), rel=0.2)
    counts = results["segment/blocks"].groupby("manoeuvre")["count"].sum()
    assert counts["up"] == pytest.approx(counts["down"], abs=1)


def test_records_that_come_again_are_one_finding_and_masked(tmp_path):
    results = two_rests(tmp_path, lambda lines: lines[:900] + lines[600:])
    findings = results["quality/findings"].set_index("cause")
    assert list(findings.index) == ["duplicate"]  # that time goes back is of their repetition
    mask = results["quality/masks"].iloc[0]
    assert (mask["from_record"], mask["to_record"], mask["repeated"]) == (900, 1200, True)
    counts = results["segment/blocks"].groupby("manoeuvre")["count"].sum()
    assert counts["up"] == counts["down"]


def test_a_storm_of_gaps_is_one_finding_with_a_count(tmp_path):
    def every_tenth_lost(lines):
        return [line for number, line in enumerate(lines) if number % 10]

    findings = two_rests(tmp_path, every_tenth_lost)["quality/findings"]
    assert list(findings["cause"]) == ["gap"]
    assert findings["count"].iloc[0] == pytest.approx(199, abs=1)


def test_records_that_the_instrument_calls_invalid_are_masked(tmp_path):
    def spoiled(lines):
        line = lines[300].replace(b"00000077", b"00000076")
        return [*lines[:300], signed(line, line), *lines[301:]]

    results = two_rests(tmp_path, spoiled)
    assert list(results["quality/findings"]["cause"]) == ["status_invalid"]
    assert results["quality/masks"].iloc[0]["from_record"] == 300


def test_a_rate_that_is_not_the_stated_one_is_named(tmp_path):
    findings = two_rests(tmp_path, **{"span-cpt": "imar-fsas"})["quality/findings"]
    assert set(findings["cause"]) == {"rate_off"}
    assert findings["size"].iloc[0] == pytest.approx(0.5)
    assert len(findings) == 1  # of both logs
    assert "÷2" in findings["sentence"].iloc[0]


def test_another_day_and_a_gravity_of_another_place_are_named(tmp_path):
    changed = {"2026-11-02": "2026-11-12", "9.7936174": "9.80665"}
    findings = two_rests(tmp_path, **changed)["quality/findings"].set_index("cause")
    assert set(findings.index) == {"wrong_day", "gravity_error"}
    assert findings.loc["wrong_day", "size"] == 10
    assert findings.loc["gravity_error", "size"] == pytest.approx(0.01306, abs=1e-5)
    assert findings.loc["gravity_error", "sensor"] == "accel"


CAMPAIGN = """\
campaign: 1
instrument:
  name: own
  rate_hz: 100
  format:
    kind: columns
    delimiter: ","
    time: {{rate_hz: 100}}
    accelerometer: {{columns: [1, 2, 3], unit: {unit}{counts}}}
serial: unknown
date: unknown
site: {{latitude_deg: 45, height_m: 0}}
table: {{name: by hand, position_sigma_arcsec: 3600}}
log: log.csv
plan:
  - {{id: up, do: rest, up: +z, seconds: 10}}
"""


@pytest.mark.parametrize(
    ("unit", "counts", "reading", "named"),
    [
        ("g", "", 9.81, "the values are in m/s² but are read as g"),
        ("m/s2", "", 1.0, "the values are in g but are read as m/s²"),
        ("g", "", 16384, "the values are counts, and counts_per_unit is missing"),
        ("g", ", counts_per_unit: 16384", 8192, "counts_per_unit is 2 times too large"),
        ("g", ", counts_per_unit: 4096", 16384, "counts_per_unit is 4 times too small"),
    ],
)
def test_a_wrong_scale_factor_is_named(unit, counts, reading, named, tmp_path):
    folder = tmp_path / "campaign"
    folder.mkdir()
    (folder / "campaign.yaml").write_text(CAMPAIGN.format(unit=unit, counts=counts))
    readings = reading * (
        np.array([0, 0, 1]) + 1e-3 * np.random.default_rng(1).normal(size=(1000, 3))
    )
    np.savetxt(folder / "log.csv", readings, delimiter=",", fmt="%.6f")
    findings = chain.run(folder, tmp_path / "derived", "quality")["quality/findings"]
    assert list(findings["cause"]) == ["wrong_scale_factor"]
    assert named in findings["sentence"].iloc[0]
    assert (findings["severity"].iloc[0], findings["sensor"].iloc[0]) == (3, "accel")
