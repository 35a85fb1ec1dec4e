"""The same rows written in every format that is read, by libraries that other people wrote."""

import struct
from collections.abc import Callable, Mapping
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from pyarrow import ipc, parquet
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.store import Typestore
from scipy.io import savemat

IMU = "sensor_msgs/msg/Imu"
AXES = ("x", "y", "z")
NAMES = ["stamp", *(f"{kind}.{axis}" for kind in ("rate", "force") for axis in AXES)]
BAG_NAMES = {"rate": "angular_velocity", "force": "linear_acceleration"}


def rows(count: int) -> NDArray[np.float64]:
    """Time, s, in whole milliseconds, and six numbers, (count, 7)."""
    numbers = np.random.default_rng(7).normal(size=(count, 7))
    numbers[:, 0] = np.arange(1000, 1000 + count) / 1000
    return numbers


def layout(names: Mapping[str, str] | None = None) -> dict[str, object]:
    """The layout of these rows, the sensors called otherwise where told."""
    rate, force = ((names or {}).get(name, name) for name in ("rate", "force"))
    return {
        "kind": "columns",
        "time": {"column": "stamp", "unit": "s"},
        "gyro": {"columns": [f"{rate}.{axis}" for axis in AXES], "unit": "rad/s"},
        "accelerometer": {"columns": [f"{force}.{axis}" for axis in AXES], "unit": "m/s2"},
    }


def matrix_layout(gyro: str, accelerometer: str, time: str) -> dict[str, object]:
    """The layout of a file of matrices with these names."""
    return {
        "kind": "columns",
        "time": {"column": time, "unit": "s"},
        "gyro": {"columns": [f"{gyro}.{axis}" for axis in (1, 2, 3)], "unit": "rad/s"},
        "accelerometer": {
            "columns": [f"{accelerometer}.{axis}" for axis in (1, 2, 3)],
            "unit": "m/s2",
        },
    }


def text(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    lines = [",".join(NAMES), *(",".join(map(repr, row)) for row in values.tolist())]
    path.write_text("\n".join(lines) + "\n")
    return layout() | {"delimiter": ",", "header_lines": 1}


def table(values: NDArray[np.float64]) -> pa.Table:
    return pa.table({name: pa.array(values[:, place]) for place, name in enumerate(NAMES)})


def as_parquet(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    parquet.write_table(table(values), path, row_group_size=300, compression="zstd")
    return layout()


def arrow_file(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    options = ipc.IpcWriteOptions(compression="zstd")
    with ipc.new_file(path, table(values).schema, options=options) as writer:
        writer.write_table(table(values), max_chunksize=300)
    return layout()


def arrow_stream(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    with ipc.new_stream(path, table(values).schema) as writer:
        writer.write_table(table(values), max_chunksize=300)
    return layout()


def matlab_5(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    savemat(
        path,
        {
            "notes": "a text is no column",
            "gyro": values[:, 1:4],
            "imu": {"time": values[:, :1], "force": values[:, 4:].T},
        },
        appendmat=False,
        do_compression=True,
    )
    return matrix_layout("gyro", "imu.force", "imu.time")


def matlab_73(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    with h5py.File(path, "w", userblock_size=512) as file:
        refs = file.create_group("#refs#")
        refs["a"] = np.zeros((3, 3))
        for name, part in {
            "gyro": values[:, 1:4],
            "imu/time": values[:, :1],
            "imu/force": values[:, 4:].T,
        }.items():
            matrix = file.create_dataset(name, data=part.T, compression="gzip", shuffle=True)
            matrix.attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as block:
        block.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")
    return matrix_layout("gyro", "imu.force", "imu.time")


def imu_message(store: Typestore, row: list[float]) -> object:
    """A row as a message; the time to the nanosecond."""
    kinds = store.types
    whole, rest = divmod(round(row[0] * 1e9), 10**9)
    vector, unknown = kinds["geometry_msgs/msg/Vector3"], np.zeros(9)
    stamp = kinds["builtin_interfaces/msg/Time"](sec=whole, nanosec=rest)
    count = {"seq": 0} if "seq" in dict(store.fielddefs["std_msgs/msg/Header"][1]) else {}
    return kinds[IMU](
        header=kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="imu", **count),
        orientation=kinds["geometry_msgs/msg/Quaternion"](x=0.0, y=0.0, z=0.0, w=1.0),
        orientation_covariance=unknown,
        angular_velocity=vector(*row[1:4]),
        angular_velocity_covariance=unknown,
        linear_acceleration=vector(*row[4:]),
        linear_acceleration_covariance=unknown,
    )


def ros_1(path: Path, values: NDArray[np.float64], topics: tuple[str, ...] = ("/imu",)):
    store = get_typestore(Stores.ROS1_NOETIC)
    bag = Writer1(path)
    bag.set_compression(Writer1.CompressionFormat.LZ4)
    with bag:
        _fill(bag, store, store.serialize_ros1, values, topics)
    return layout(BAG_NAMES)


def ros_2(path: Path, values: NDArray[np.float64], topics: tuple[str, ...] = ("/imu",)):
    return _ros_2(path, values, topics, StoragePlugin.SQLITE3, ".db3")


def mcap(path: Path, values: NDArray[np.float64], topics: tuple[str, ...] = ("/imu",)):
    return _ros_2(path, values, topics, StoragePlugin.MCAP, ".mcap")


def _ros_2(path, values, topics, plugin, ending):
    store = get_typestore(Stores.ROS2_HUMBLE)
    folder = path.with_name(path.name + "-folder")
    bag = Writer2(folder, version=9, storage_plugin=plugin)
    if plugin is StoragePlugin.MCAP:
        bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with bag:
        _fill(bag, store, store.serialize_cdr, values, topics)
    (folder / (folder.name + ending)).rename(path)
    return layout(BAG_NAMES)


def _fill(bag, store, serialize, values, topics):
    word = store.types["std_msgs/msg/String"]
    chat = bag.add_connection("/chat", "std_msgs/msg/String", typestore=store)
    imus = [bag.add_connection(topic, IMU, typestore=store) for topic in topics]
    for number, row in enumerate(values.tolist()):
        received = round(row[0] * 1e9)
        for imu in imus:
            bag.write(imu, received, serialize(imu_message(store, row), IMU))
        if number % 10 == 0:
            bag.write(chat, received, serialize(word(data="hello"), "std_msgs/msg/String"))


def numpy_array(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    table = np.rec.fromarrays(values.T, dtype=[(name, "f8") for name in NAMES])
    with path.open("wb") as file:  # a name would get the ending .npy
        np.save(file, table)
    return layout()


def numpy_archive(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    imu = np.zeros(len(values), [("time", "f8"), ("force", ">f8", (3,)), ("name", "U3")])
    imu["time"], imu["force"] = values[:, 0], values[:, 4:]
    notes = np.array([{"an object": "is no column"}], object)
    with path.open("wb") as file:
        np.savez_compressed(file, gyro=np.asfortranarray(values[:, 1:4]), imu=imu, notes=notes)
    return matrix_layout("gyro", "imu.force", "imu.time")


ULOG_FIELDS = "uint64_t timestamp;double stamp;double[3] gyro_rad;double[3] accelerometer_m_s2;"


def ulog(path: Path, values: NDArray[np.float64]) -> dict[str, object]:
    """By the description of the format: definitions, and messages of two topics."""
    head = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1_000_000)
    definitions = [
        ulog_message("B", bytes(40)),
        ulog_message("F", f"sensor_combined:{ULOG_FIELDS}".encode()),
        ulog_message("F", b"cpuload:uint64_t timestamp;float load;"),
        ulog_message("A", struct.pack("<BH", 0, 7) + b"sensor_combined"),
        ulog_message("A", struct.pack("<BH", 0, 8) + b"cpuload"),
    ]
    data = []
    for number, row in enumerate(values.tolist()):
        stamp = round(row[0] * 1e6)
        data.append(ulog_message("D", struct.pack("<HQ7d", 7, stamp, *row)))
        if number % 10 == 0:
            data.append(ulog_message("D", struct.pack("<HQf", 8, stamp, 0.5)))
    path.write_bytes(head + b"".join(definitions + data))
    names = {
        "gyro": {"columns": [f"gyro_rad[{axis}]" for axis in range(3)], "unit": "rad/s"},
        "accelerometer": {
            "columns": [f"accelerometer_m_s2[{axis}]" for axis in range(3)],
            "unit": "m/s2",
        },
    }
    return layout() | names


def ulog_message(kind: str, content: bytes) -> bytes:
    return struct.pack("<HB", len(content), ord(kind)) + content


WRITERS: dict[str, Callable[..., dict[str, object]]] = {
    "text": text,
    "parquet": as_parquet,
    "arrow file": arrow_file,
    "arrow stream": arrow_stream,
    "matlab 5": matlab_5,
    "matlab 7.3": matlab_73,
    "ros 1": ros_1,
    "ros 2": ros_2,
    "mcap": mcap,
    "numpy": numpy_array,
    "numpy archive": numpy_archive,
    "ulog": ulog,
}
CONTAINERS = [name for name in WRITERS if name != "text"]
