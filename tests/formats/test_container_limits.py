"""A few bytes that unpack to more than the memory limit are refused, and nothing else fails."""

import io
import resource
import struct
import subprocess
import sys
import zipfile
import zlib
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from multiprocessing import get_context
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pytest
from pyarrow import ipc, parquet
from rosbags.rosbag1 import Writer as Writer1
from rosbags.typesys import Stores, get_typestore
from scipy.io import savemat

from inertial.formats.columns import column_reader
from inertial.formats.containers import container, ulog_file
from inertial.tables.errors import Refusal
from tests.formats import written

LAYOUT = {"kind": "columns", "time": {"column": "x", "unit": "s"}}
MANY = 1 << 24  # numbers: 128 MiB
LIMIT = 1 << 25  # byte: a quarter of it
FEW = 1 << 20  # numbers that the limit allows


def read(log, layout=LAYOUT):
    """The refusal of a log, or how many readings it has."""
    before = resource.getrlimit(resource.RLIMIT_AS)
    try:
        return len(list(column_reader.read(log, layout)))
    except Refusal as refusal:
        assert refusal.file == log.name
        return refusal
    finally:
        assert resource.getrlimit(resource.RLIMIT_AS) == before
        assert len(np.ones(MANY)) == MANY  # what is not a reader's is not limited


def read_there(log, layout):
    """The same as what a process can return."""
    answer = read(log, layout)
    return asdict(answer) if isinstance(answer, Refusal) else answer


def lower_the_limit(folder):
    """So that a test needs no gigabytes; the libraries are loaded before."""
    for number, name in enumerate(written.CONTAINERS):
        small = folder / f"small {number}"
        layout = written.WRITERS[name](small, written.rows(10))
        list(column_reader.read(small, layout))
    container.MAX_READER_BYTES = LIMIT
    pa.set_memory_pool(pa.system_memory_pool())  # pyarrow's own has a reserve of a gigabyte


@pytest.fixture(scope="module")
def limited(tmp_path_factory):
    """`read` with the lower limit, in a process of its own.

    The limit is on the address space: a process that has freed much, as one that ran other tests,
    may use that again beyond the limit.
    """
    folder = tmp_path_factory.mktemp("small")
    with ProcessPoolExecutor(1, get_context("spawn"), lower_the_limit, (folder,)) as process:

        def limited_read(log, layout=LAYOUT):
            answer = process.submit(read_there, log, layout).result()
            return Refusal(**answer) if isinstance(answer, dict) else answer

        yield limited_read


def assert_a_bomb(log, refusal):
    assert log.stat().st_size < MANY // 20
    assert refusal.found.startswith("a file that unpacks to too much at once: ")
    assert refusal.expected == f"at most {LIMIT} bytes of memory to read it"
    assert refusal.cure.startswith("write the log anew in smaller pieces; ")


@pytest.mark.slow
def test_a_row_group_of_parquet(tmp_path, limited):
    log = tmp_path / "log"
    parquet.write_table(pa.table({"x": np.arange(FEW) * 0.1}), log, row_group_size=FEW // 4)
    assert limited(log) > 4
    words = pa.table({"x": pa.array(["x" * (1 << 20)] * (MANY >> 17))})
    parquet.write_table(words, log, compression="zstd", use_dictionary=False)
    assert_a_bomb(log, limited(log))


def test_more_rows_in_parquet_than_a_file_can_hold(tmp_path):
    log = tmp_path / "log"
    zeros = pa.table({"x": np.zeros(4 * FEW, np.int8)})
    parquet.write_table(zeros, log, max_rows_per_page=4 * FEW)
    refusal = read(log)
    assert refusal.found == f"{4 * FEW} rows stated in {log.stat().st_size} bytes"
    assert refusal.cure.startswith("copy the log anew")


@pytest.mark.parametrize("opened", [ipc.new_file, ipc.new_stream])
@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_batch_of_arrow(tmp_path, limited, opened, compression):
    log, table = tmp_path / "log", pa.table({"x": np.zeros(MANY)})
    options = ipc.IpcWriteOptions(compression=compression)
    with opened(log, table.schema, options=options) as writer:
        writer.write_table(table)
    del table
    assert_a_bomb(log, limited(log))


@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_batch_of_arrow_that_claims_too_much(tmp_path, compression):
    log, table = tmp_path / "log", pa.table({"x": np.zeros(1000)})
    with ipc.new_stream(
        log, table.schema, options=ipc.IpcWriteOptions(compression=compression)
    ) as writer:
        writer.write_table(table)
    stated, claimed = struct.pack("<q", 8000), struct.pack("<q", 1 << 36)
    content = log.read_bytes()
    assert content.count(stated) == 1
    log.write_bytes(content.replace(stated, claimed))
    refusal = read(log)
    assert refusal.found.startswith("a file that unpacks to too much at once: ")
    assert refusal.expected == "at most 4294967296 bytes of memory to read it"


def test_a_variable_of_matlab_5(tmp_path, limited):
    log = tmp_path / "log"
    savemat(log, {"x": np.zeros(MANY)}, appendmat=False, do_compression=True)
    assert_a_bomb(log, limited(log))


def test_a_chunk_of_hdf5_that_unpacks_to_more_than_it_has(tmp_path, limited):
    log = tmp_path / "log"
    with h5py.File(log, "w") as file:
        matrix = file.create_dataset("x", (2000,), "f8", chunks=(1000,), compression="gzip")
        matrix[:] = np.random.default_rng(1).normal(size=2000)
    assert limited(log) == 1
    with h5py.File(log, "r+") as file:
        file["x"].id.write_direct_chunk((1000,), zlib.compress(bytes(8 * MANY)))
    refusal = limited(log)  # the library does not say why its filter failed
    assert refusal.found.startswith("a file that cannot be read: Can't synchronously read data")
    assert refusal.cure.startswith("copy the log anew")


def test_a_chunk_and_a_matrix_of_hdf5_that_claim_too_much(tmp_path, limited):
    log = tmp_path / "log"
    with h5py.File(log, "w") as file:
        file.create_dataset("x", (1 << 40,), "f8", chunks=(1000,))
    assert limited(log).expected == "at most 1032 rows per byte"
    with h5py.File(log, "w") as file:
        file.create_dataset("x", data=np.zeros(MANY), chunks=(MANY,), compression="gzip")
    assert_a_bomb(log, limited(log))


def test_hdf5_is_not_followed_out_of_the_file(tmp_path):
    log, elsewhere = tmp_path / "log", tmp_path / "elsewhere"
    np.arange(100.0).tofile(elsewhere)
    with h5py.File(tmp_path / "other", "w") as file:
        file["x"] = np.arange(100.0)
    with h5py.File(log, "w") as file:
        file["x"] = h5py.ExternalLink(str(tmp_path / "other"), "x")
        file["here"] = np.arange(3.0)
    assert read(log).expected == "one of here"
    with h5py.File(log, "w") as file:
        file.create_dataset("x", (100,), "f8", external=[(str(elsewhere), 0, 800)])
    assert read(log).found == "a matrix whose values lie in another file"


def test_a_group_of_hdf5_that_holds_itself_is_opened_once(tmp_path):
    log = tmp_path / "log"
    with h5py.File(log, "w") as file:
        group = file.create_group("imu")
        group["y"] = np.arange(3.0)
        for name in range(200):
            group[f"again{name}"] = group
            file[f"again{name}"] = file["/"]
    assert len(read(log).expected.split(", ")) == 1  # under whichever name comes first


def ros_1_bomb(log, compression):
    """A bag with a chunk of zeros."""
    store = get_typestore(Stores.ROS1_NOETIC)
    bag = Writer1(log)
    bag.set_compression(compression)
    with bag:
        imu = bag.add_connection("/imu", written.IMU, typestore=store)
        bag.write(imu, 1, bytes(8 * MANY))


@pytest.mark.parametrize("compression", ["LZ4", pytest.param("BZ2", marks=pytest.mark.slow)])
def test_a_chunk_of_a_ros_1_bag(tmp_path, limited, compression):
    log = tmp_path / "log"
    ros_1_bomb(log, Writer1.CompressionFormat[compression])
    assert_a_bomb(log, limited(log, written.layout(written.BAG_NAMES)))


def test_a_chunk_of_an_mcap_bag(tmp_path, limited):
    log = tmp_path / "log"
    layout = written.mcap(log, written.rows(10))
    chunk = pa.Codec("zstd").compress(bytes(8 * MANY), asbytes=True)
    head = struct.pack("<QQQII4sQ", 0, 0, 8 * MANY, 0, 4, b"zstd", len(chunk))
    record = struct.pack("<BQ", 6, len(head) + len(chunk)) + head + chunk
    content = log.read_bytes()
    log.write_bytes(content[:8] + record + content[8:])
    assert_a_bomb(log, limited(log, layout))


def test_the_limit_counts_from_what_is_in_use(tmp_path):
    log = tmp_path / "log"
    layout = written.as_parquet(log, written.rows(1000))
    program = (
        "import mmap, sys; from pathlib import Path\n"
        "from inertial.formats.columns import column_reader\n"
        "reserved = mmap.mmap(-1, 20 << 30, flags=mmap.MAP_PRIVATE | 0x4000)\n"
        f"readings = column_reader.read(Path(sys.argv[1]), {layout})\n"
        "print(sum(len(reading.records.record) for reading in readings))"
    )
    run = [sys.executable, "-c", program, str(log)]
    home = Path(__file__).parents[2]
    answer = subprocess.run(run, capture_output=True, text=True, check=True, cwd=home)
    assert answer.stdout == "1000\n"


def test_columns_of_different_length_are_refused(tmp_path):
    log = tmp_path / "log"
    savemat(log, {"x": np.zeros(5), "gyro": np.zeros((6, 3))}, appendmat=False)
    layout = LAYOUT | {"gyro": {"columns": ["gyro.1", "gyro.2", "gyro.3"], "unit": "g"}}
    assert read(log, layout).found == "5 samples of x, 6 samples of gyro.3"


# ---- NumPy


def claimed(shape: tuple[int, ...], dtype: str = "<f8") -> bytes:
    """An .npy whose header states this shape, and 80 bytes of data."""
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        file, {"descr": dtype, "fortran_order": False, "shape": shape}
    )
    return file.getvalue() + bytes(80)


def test_an_array_of_numpy_that_claims_too_much(tmp_path, limited):
    log = tmp_path / "log"
    log.write_bytes(claimed((1 << 40, 7)))
    refusal = limited(log, LAYOUT | {"time": {"column": 1, "unit": "s"}})
    assert refusal.cure.startswith("copy the log anew")
    with zipfile.ZipFile(log, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("x.npy", claimed((MANY,)) + bytes(8 * MANY - 80))
    assert_a_bomb(log, limited(log))


def test_no_pickled_object_is_loaded(tmp_path):
    log = tmp_path / "log"
    with log.open("wb") as file:
        np.save(file, np.array([{"x": 1}], object), allow_pickle=True)
    assert read(log).found.startswith("a file that cannot be read: Array can't be memory-mapped")
    with log.open("wb") as file:
        np.savez(file, x=np.array([{"x": 1}], object), y=np.zeros(3))
    assert read(log).expected == "one of y"


# ---- ULog


def ulog(log: Path, *messages: bytes) -> None:
    log.write_bytes(b"ULog\x01\x12\x35\x01" + bytes(8) + b"".join(messages))


def test_formats_of_ulog_within_each_other_define_no_endless_message(tmp_path):
    """Four lines would be 65535³ fields, of no bytes at all."""
    log = tmp_path / "log"
    ulog(
        log,
        written.ulog_message("F", b"sensor_combined:a[65535] x;"),
        written.ulog_message("F", b"a:b[65535] x;"),
        written.ulog_message("F", b"b:c[65535] x;"),
        written.ulog_message("F", b"c:"),
        written.ulog_message("A", struct.pack("<BH", 0, 7) + b"sensor_combined"),
    )
    refusal = read(log)
    assert f"{65535**3} fields in a message of sensor_combined" in refusal.found
    ulog(
        log,
        written.ulog_message("F", b"sensor_combined:uint64_t timestamp;sensor_combined[2] x;"),
        written.ulog_message("A", struct.pack("<BH", 0, 7) + b"sensor_combined"),
    )
    assert "recursion" in read(log).found


def test_a_ulog_is_not_read_for_ever(tmp_path, monkeypatch):
    """Each of 2000 messages of 10 bytes subscribes to a topic of 65000 fields."""
    log = tmp_path / "log"
    again = written.ulog_message("A", struct.pack("<BH", 0, 7) + b"cpuload")
    ulog(log, written.ulog_message("F", b"cpuload:uint64_t timestamp;bool[65000] x;"), again * 2000)
    monkeypatch.setattr(ulog_file, "MAX_SECONDS", 0.5)
    assert read(log).found.endswith("takes longer than any whole log of its size")


def test_what_the_reader_of_ulogs_prints_is_not_printed(tmp_path, capsys):
    log = tmp_path / "log"
    layout = written.ulog(log, written.rows(50))
    log.write_bytes(log.read_bytes() + written.ulog_message("D", struct.pack("<HQ", 99, 0)))
    readings = list(column_reader.read(log, layout))
    assert [line.reason for reading in readings for line in reading.refused] == [
        "the log is damaged: messages may be missing, and numbers may be wrong"
    ]
    assert capsys.readouterr() == ("", "")
