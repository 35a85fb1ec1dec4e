"""What is no log, and a log that gives no sample: refused by name with the cure."""

import io
import zipfile
from pathlib import Path

import chain
import pytest
from decoded_logs import SPAN_CPT, at, one

from inertial.tables.errors import Refusal

COLUMNS = {
    "kind": "columns",
    "delimiter": ",",
    "header_lines": 1,
    "time": {"column": "t", "unit": "s"},
    "gyro": {"columns": ["x", "y", "z"], "unit": "rad/s"},
}
HEADER = b"t,x,y,z\n"


def workbook() -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("xl/workbook.xml", "<workbook/>")
    return file.getvalue()


# What users download or export instead of a log, as git, web servers and programs write it.
NO_LOGS = {
    "pointer": (
        b"version https://git-lfs.github.com/spec/v1\n"
        b"oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\n"
        b"size 12345\n",
        "a pointer of Git LFS, not the log",
        "git lfs pull",
    ),
    "page": (b"\n<!DOCTYPE html>\n<html lang='en'>", "a page of HTML or XML", "the file itself"),
    "page with a mark of bytes": (b"\xef\xbb\xbf<HTML><head>", "a page of HTML", "the file itself"),
    "error of a server": (b"<?xml version='1.0'?><Error>", "a page of HTML or XML", "itself"),
    "empty": (b"", "an empty file", "copy it anew"),
    "gzip": (b"\x1f\x8b\x08\x00\x00\x00", "packed with gzip", "unpack it"),
    "zip": (b"PK\x03\x04" + bytes(22) + b"\x07\0\0\0log.csv", "packed with zip", "unpack it"),
    "workbook": (workbook(), "a spreadsheet", "CSV"),
    "old workbook": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(504), "a spreadsheet", "CSV"),
    "document": (b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n", "a PDF", "name the log"),
    "picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "a picture", "name the log"),
    "photo": (b"\xff\xd8\xff\xe0\0\x10JFIF", "a picture", "name the log"),
    "UTF-16": (HEADER.decode().encode("utf-16"), "text in UTF-16", "iconv -f UTF-16"),
    "packets": (b"\xd4\xc3\xb2\xa1\x02\0\x04\0" + bytes(16), "network packets", "Wireshark"),
    "flight": (b"\xa3\x95\x80\x80\x59FMT\0BBnNZ", "a DataFlash log", "mavlogdump.py"),
}


@pytest.mark.parametrize("layout", [SPAN_CPT, COLUMNS], ids=["receiver", "columns"])
@pytest.mark.parametrize("name", NO_LOGS)
def test_what_is_no_log_is_refused_with_the_cure(tmp_path, name, layout):
    content, found, cure = NO_LOGS[name]
    log = tmp_path / "log.asc"
    log.write_bytes(content)
    refusal = refused(log, layout)
    assert found in refusal.found
    assert cure in refusal.cure


def refused(log: Path, layout: dict) -> Refusal:
    with pytest.raises(Refusal) as refusal:
        one(log, layout)
    assert refusal.value.file == log.name
    return refusal.value


# ---- a log without a sample


def test_a_receiver_without_raw_data_says_what_it_has(recordings):
    """Real ones: SOURCE.md counts 243 INSPVAS, 10 CORRIMUS and 31 others in the first."""
    refusal = refused(recordings / "novatel_samples/oem7_ins1.gps", SPAN_CPT)
    assert refusal.found == (
        "no raw data of an IMU, but 243 INSPVAS, 29 INSSTDEV, 10 CORRIMUS, 2 INSCONFIG"
    )
    assert refusal.expected == "RAWIMU, RAWIMUS, RAWIMUX, RAWIMUSX"
    assert "LOG RAWIMUSXB ONNEW" in refusal.cure
    assert (
        "766 IMURATECORRIMUS"
        in refused(recordings / "novatel_samples/oem7_ins2.gps", SPAN_CPT).found
    )


def test_messages_of_which_none_has_a_right_checksum(tmp_path):
    log = tmp_path / "log.asc"
    lines = [at(2283, 100 + n / 100).replace(b"*", b"*f", 1) for n in range(3)]
    log.write_bytes(b"".join(lines))
    refusal = refused(log, SPAN_CPT)
    assert refusal.place == "line 1"
    assert refusal.found.startswith("all 3 lines are refused, this one because: ")
    assert "checksum" in refusal.found


def test_columns_in_a_format_of_messages_and_the_reverse(tmp_path):
    log = tmp_path / "log.csv"
    log.write_bytes(b"1,2,3,4\n" * 20)
    refusal = refused(log, SPAN_CPT)
    assert "begins with '1', expected '%', '#'" in refusal.found
    assert refusal.cure.endswith("give its manoeuvres a format of kind columns")
    log.write_bytes(HEADER + at(2283, 100.0) * 20)
    refusal = refused(log, COLUMNS)
    assert refusal.place == "line 2"
    assert refusal.found.startswith("all 20 lines are refused, this one because: ")
    assert "%RAWIMUSA" in refusal.found
    assert 'delimiter ","' in refusal.expected
    assert "gyro [x, y, z]" in refusal.expected


@pytest.mark.parametrize(
    ("content", "layout", "found"),
    [
        (HEADER, COLUMNS, "no row of data behind 1 line of header"),
        (HEADER + b"\n\n", COLUMNS, "no row of data behind 3 lines of header"),
        (
            HEADER + b"1,2,3,4\n" * 5,
            COLUMNS | {"gyro": COLUMNS["gyro"] | {"rows": {"t": "2"}}},
            "none of its 5 rows holds a sensor",
        ),
    ],
)
def test_rows_without_a_sensor(tmp_path, content, layout, found):
    log = tmp_path / "log.csv"
    log.write_bytes(content)
    assert refused(log, layout).found == found


# ---- in a campaign


@pytest.mark.parametrize("name", ["pointer", "page", "empty", "zip"])
def test_a_campaign_stops_at_the_log_by_name(tmp_path, name):
    raw = chain.simulate(chain.short(), tmp_path / "raw")
    (raw / "y-up.asc").write_bytes(NO_LOGS[name][0])
    with pytest.raises(Refusal) as refusal:
        chain.run(raw, tmp_path / "derived", "decode")
    assert refusal.value.file == "y-up.asc"
    assert NO_LOGS[name][1] in refusal.value.found


def test_a_folder_is_no_log(tmp_path):
    raw = chain.simulate(chain.short(), tmp_path / "raw")
    (raw / "y-up.asc").unlink()
    (raw / "y-up.asc").mkdir()
    with pytest.raises(Refusal) as refusal:
        chain.run(raw, tmp_path / "derived", "plan")
    line = 1 + [
        "y-up.asc" in text for text in (raw / "campaign.yaml").read_text().splitlines()
    ].index(True)
    assert refusal.value.place.startswith(f"line {line}")
    assert refusal.value.found == "'y-up.asc', a folder"


@pytest.mark.parametrize(
    ("line", "cure"),
    [
        (b"0,01;-9,81;0,2;0;1;2;3,5\n", 'state delimiter: ";", decimal: "," in the format'),
        (b"0.01;-9.81;0.2;0;1;2;3.5\n", 'state delimiter: ";" in the format'),
        (b"0,01 -9,81 0,2 0 1 2 3,5\n", 'state no delimiter, decimal: "," in the format'),
        (b"0.01,-9.81,0.2,0,1,?,2\n", "compare this line with the format"),
    ],
)
def test_a_line_that_is_separated_otherwise_says_how(tmp_path, line, cure):
    log = tmp_path / "log.csv"
    log.write_bytes(b"t,x,y,z,gx,gy,gz\n" + line * 20)
    positional = COLUMNS | {
        "time": {"column": 1, "unit": "s"},
        "accelerometer": {"columns": [2, 3, 4], "unit": "g"},
        "gyro": {"columns": [5, 6, 7], "unit": "deg/s"},
        "header_lines": 1,
    }
    assert refused(log, positional).cure.startswith(cure)
