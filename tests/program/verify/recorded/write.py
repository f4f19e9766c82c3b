"""Writes the compressed recordings beside this file, as rosbag2 lays them out: pip install mcap, then python write.py."""

import struct

from mcap.writer import CompressionType, Writer


def align(data, size):
    data += b"\0" * (-(len(data) - 4) % size)


def text(data, value):
    align(data, 4)
    data += struct.pack("<I", len(value) + 1) + value.encode() + b"\0"


def numbers(data, values):
    align(data, 4)
    data += struct.pack("<I", len(values))
    for value in values:
        align(data, 8)
        data += struct.pack("<d", value)


def state(nanoseconds, names, values):
    data = bytearray(b"\0\1\0\0") + struct.pack("<iI", nanoseconds // 10**9, nanoseconds % 10**9)
    text(data, "")
    align(data, 4)
    data += struct.pack("<I", len(names))
    for name in names:
        text(data, name)
    for row in (values, [float("nan")] * len(values), []):
        numbers(data, row)
    return bytes(data)


def record(path, compression):
    with open(path, "wb") as file:
        writer = Writer(file, chunk_size=1024, compression=compression)
        writer.start(profile="ros2", library="rosbag2")
        kind = writer.register_schema(name="sensor_msgs/msg/JointState", encoding="ros2msg", data=b"")
        topic = writer.register_channel(topic="/scara/joint_states", message_encoding="cdr", schema_id=kind)
        # Two by two in the wrong order, and every second one with its names in another order.
        for number in (k + 1 - 2 * (k % 2) for k in range(40)):
            at, values = 10**9 + number * 50_000_000, {"shoulder": -0.9 + 0.01 * number, "elbow": 0.4 + 0.01 * number}
            names = sorted(values, reverse=number % 2 == 1)
            message = state(at, names, [values[name] for name in names])
            writer.add_message(topic, log_time=at + 5, publish_time=at + 5, data=message)
        writer.finish()


record("zstd.mcap", CompressionType.ZSTD)
record("lz4.mcap", CompressionType.LZ4)
