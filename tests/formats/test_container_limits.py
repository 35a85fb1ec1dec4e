"""A few bytes that claim to unpack to more than fits are refused before they are unpacked."""

import zlib

import h5py
import numpy as np
import pyarrow as pa
import pytest
from pyarrow import ipc, parquet
from scipy.io import savemat

from inertial.tables.errors import Refusal
from stages.formats import columns, hdf5_sizes, limits, matlab5_sizes
from stages.formats.arrow_claims import claimed_bytes
from tests.formats import written

LAYOUT = {"kind": "columns", "time": {"column": "x", "unit": "s"}}
MANY = 1 << 20  # numbers
LIMIT = 1 << 22  # byte: half of what so many numbers take


@pytest.fixture
def limit(monkeypatch):
    """The limit lowered, that a test needs no gigabyte."""
    for module in (limits, matlab5_sizes, hdf5_sizes):
        monkeypatch.setattr(module, "LARGEST_PIECE", LIMIT)


def refused(log, layout=LAYOUT):
    with pytest.raises(Refusal) as refusal:
        list(columns.read(log, layout))
    return refusal.value


def test_a_row_group_of_parquet(tmp_path, limit):
    log = tmp_path / "log"
    parquet.write_table(pa.table({"x": np.arange(MANY) * 0.1}), log, row_group_size=MANY // 4)
    assert len(list(columns.read(log, LAYOUT))) > 4
    parquet.write_table(pa.table({"x": np.zeros(MANY)}), log, row_group_size=MANY)
    assert log.stat().st_size < 10_000
    refusal = refused(log)
    assert (refusal.place, refusal.found) == ("row group 0", "8388608 bytes, as the file says")
    assert refusal.expected == "at most 4194304 bytes in one piece"


def test_more_rows_in_parquet_than_a_file_can_hold(tmp_path):
    log = tmp_path / "log"
    zeros = pa.table({"x": np.zeros(4 * MANY, np.int8)})
    parquet.write_table(zeros, log, max_rows_per_page=4 * MANY)
    assert refused(log).place == "its rows"


@pytest.mark.parametrize("opened", [ipc.new_file, ipc.new_stream])
@pytest.mark.parametrize("compression", ["zstd", "lz4"])
def test_a_batch_of_arrow(tmp_path, limit, opened, compression):
    log, table = tmp_path / "log", pa.table({"x": np.zeros(MANY)})
    options = ipc.IpcWriteOptions(compression=compression)
    with opened(log, table.schema, options=options) as writer:
        writer.write_table(table)
    assert log.stat().st_size < 100_000
    refusal = refused(log)
    assert (refusal.place, refusal.found) == ("message 1", "8388608 bytes, as the file says")


def test_the_claims_of_arrow_are_those_of_its_buffers(tmp_path):
    log = tmp_path / "log"
    words = pa.array(["one", "two", None, "one"] * 500)
    table = pa.table({"a": np.arange(2000.0), "b": words, "c": words.dictionary_encode()})
    for compression in ("zstd", "lz4", None):
        options = ipc.IpcWriteOptions(compression=compression)
        with ipc.new_stream(log, table.schema, options=options) as writer:
            writer.write_table(table)
        with pa.memory_map(str(log)) as source:
            messages = list(ipc.MessageReader.open_stream(source))
            claims = [claimed_bytes(message) for message in messages]
        assert claims[0] == 0  # the schema
        assert table.nbytes <= sum(claims) < table.nbytes + 1000


def test_a_variable_of_matlab_5(tmp_path, limit):
    log = tmp_path / "log"
    savemat(log, {"x": np.zeros(MANY)}, appendmat=False, do_compression=True)
    assert log.stat().st_size < 20_000
    assert refused(log).place == "variable 1"


def test_a_chunk_of_hdf5_that_unpacks_to_more_than_it_has(tmp_path, limit, monkeypatch):
    log = tmp_path / "log"
    monkeypatch.setattr(hdf5_sizes, "_LITTLE", 100)
    with h5py.File(log, "w") as file:
        matrix = file.create_dataset("x", (2000,), "f8", chunks=(1000,), compression="gzip")
        matrix[:] = np.random.default_rng(1).normal(size=2000)
    assert len(list(columns.read(log, LAYOUT))) == 1
    with h5py.File(log, "r+") as file:
        file["x"].id.write_direct_chunk((1000,), zlib.compress(bytes(8 * MANY)))
    assert refused(log).found.startswith("a chunk that unpacks to more than the 8000 bytes")


def test_a_chunk_and_a_matrix_of_hdf5_that_claim_too_much(tmp_path, limit):
    log = tmp_path / "log"
    with h5py.File(log, "w") as file:
        file.create_dataset("x", (1 << 40,), "f8", chunks=(1000,))
    assert refused(log).expected == "at most 1032 times as many as are stored"
    with h5py.File(log, "w") as file:
        file.create_dataset("x", data=np.zeros(MANY), chunks=(MANY,), compression="gzip")
    assert refused(log).expected == "at most 4194304 bytes in one piece"


def test_hdf5_is_not_followed_out_of_the_file(tmp_path):
    log, elsewhere = tmp_path / "log", tmp_path / "elsewhere"
    np.arange(100.0).tofile(elsewhere)
    with h5py.File(tmp_path / "other", "w") as file:
        file["x"] = np.arange(100.0)
    with h5py.File(log, "w") as file:
        file["x"] = h5py.ExternalLink(str(tmp_path / "other"), "x")
        file["here"] = np.arange(3.0)
    assert refused(log).expected == "one of here"
    with h5py.File(log, "w") as file:
        file.create_dataset("x", (100,), "f8", external=[(str(elsewhere), 0, 800)])
    assert refused(log).found == "a matrix whose values lie in another file"


def test_a_group_of_hdf5_that_holds_itself_is_opened_once(tmp_path):
    log = tmp_path / "log"
    with h5py.File(log, "w") as file:
        group = file.create_group("imu")
        group["y"] = np.arange(3.0)
        for name in range(200):
            group[f"again{name}"] = group
            file[f"again{name}"] = file["/"]
    assert len(refused(log).expected.split(", ")) == 1  # under whichever name comes first


@pytest.mark.parametrize("name", ["ros 1", "mcap"])
def test_a_chunk_of_a_bag(tmp_path, monkeypatch, name):
    log = tmp_path / "log"
    layout = written.WRITERS[name](log, np.ones((2000, 7)))
    monkeypatch.setattr(limits, "LARGEST_PIECE", 1 << 18)
    assert log.stat().st_size < 1 << 18
    assert refused(log, layout).place == "a chunk"


def test_columns_of_different_length_are_refused(tmp_path):
    log = tmp_path / "log"
    savemat(log, {"x": np.zeros(5), "gyro": np.zeros((6, 3))}, appendmat=False)
    layout = LAYOUT | {"gyro": {"columns": ["gyro.1", "gyro.2", "gyro.3"], "unit": "g"}}
    assert refused(log, layout).found == "5 samples of x, 6 samples of gyro.3"
