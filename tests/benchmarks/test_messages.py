"""Decoding: what the decoder by hand saves, and that a cloud is not copied."""

from __future__ import annotations

import statistics
import time
import tracemalloc
from collections.abc import Callable
from typing import Any

import numpy as np

from sambot_viz.frames import FrameHistory
from sambot_viz.messages import MessageTypes, Schema, TransformDecoder
from sambot_viz.sources.message import Recorded, TopicChannel
from sambot_viz.topics.decoding import Decoding
from sambot_viz.topics.transforms import TransformTopics

FRAMES = 300
MICROSECONDS = 60
"""For a message of 300 transforms; printed, and judged with the slack of a busy
machine."""
LEAST_RATIO = 15
RATE, TAKEN, SHARE = 1000, 500, 0.15
"""Messages in a second, so many of them, and the part of a core that they may take."""


def medians(*ways: Callable[[], object], rounds: int = 15) -> list[float]:
    """Median seconds of each, run in turn, ten times each."""
    times: list[list[float]] = [[] for _ in ways]
    for _ in range(rounds):
        for way, spent in zip(ways, times, strict=True):
            start = time.perf_counter()
            for _ in range(10):
                way()
            spent.append((time.perf_counter() - start) / 10)
    return [statistics.median(each) for each in times]


def transforms(store: Any, nanoseconds: int = 7_000_000_005) -> bytes:
    time = store.types["builtin_interfaces/msg/Time"]
    stamp = time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
    head, row, transform, vector, turn = (
        store.types[name]
        for name in (
            "std_msgs/msg/Header",
            "geometry_msgs/msg/TransformStamped",
            "geometry_msgs/msg/Transform",
            "geometry_msgs/msg/Vector3",
            "geometry_msgs/msg/Quaternion",
        )
    )
    rows = [
        row(
            header=head(stamp=stamp, frame_id=f"robot_link_{number}"),
            child_frame_id=f"robot_link_{number + 1}",
            transform=transform(
                translation=vector(x=float(number), y=0.0, z=0.0),
                rotation=turn(x=0.0, y=0.0, z=0.0, w=1.0),
            ),
        )
        for number in range(FRAMES)
    ]
    name = "tf2_msgs/msg/TFMessage"
    return bytes(store.serialize_cdr(store.types[name](transforms=rows), name))


def test_transforms_cost_a_fraction_of_what_rosbags_takes() -> None:
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    payload, name = transforms(store), "tf2_msgs/msg/TFMessage"
    decoder = TransformDecoder("cdr")
    ((_, edges, poses),) = decoder.decode(payload)
    assert len(edges) == FRAMES
    assert poses[:, 0].tolist() == list(range(FRAMES))
    ours, theirs = medians(
        lambda: decoder.decode(payload), lambda: store.deserialize_cdr(payload, name)
    )
    print(f"\n{FRAMES} transforms: {ours * 1e6:.0f} µs, rosbags {theirs * 1e6:.0f} µs")
    assert theirs / ours >= LEAST_RATIO
    assert ours * 1e6 <= 4 * MICROSECONDS


def test_a_cloud_of_a_megabyte_is_not_copied() -> None:
    from rosbags.typesys import Stores, get_typestore

    store, name = get_typestore(Stores.ROS2_JAZZY), "sensor_msgs/msg/PointCloud2"
    size = 1 << 20
    message = store.types[name](
        header=store.types["std_msgs/msg/Header"](
            stamp=store.types["builtin_interfaces/msg/Time"](sec=7, nanosec=5),
            frame_id="lidar",
        ),
        height=1,
        width=size // 16,
        fields=[],
        is_bigendian=False,
        point_step=16,
        row_step=size,
        data=np.zeros(size, np.uint8),
        is_dense=True,
    )
    payload = bytes(store.serialize_cdr(message, name))
    decoder = MessageTypes(distro="jazzy").decoder(Schema(name), "cdr")
    decoder.decode(payload)
    tracemalloc.start()
    try:
        cloud = decoder.decode(payload)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < size / 10
    assert np.shares_memory(cloud.data, np.frombuffer(payload, np.uint8))
    assert not cloud.data.flags.writeable
    decoding, copying = medians(
        lambda: decoder.decode(payload), lambda: bytearray(payload)
    )
    print(f"\n1 MB: {decoding * 1e6:.0f} µs, a copy of it {copying * 1e6:.0f} µs")


def test_300_frames_at_1_khz_leave_most_of_a_core() -> None:
    """Decoded and kept, as for every picture."""
    from rosbags.typesys import Stores, get_typestore

    store, name = get_typestore(Stores.ROS2_JAZZY), "tf2_msgs/msg/TFMessage"
    text = store.generate_msgdef(name, ros_version=2)[0]
    channel = TopicChannel("/tf", Schema(name, "ros2msg", text), "cdr")
    period = round(1e9 / RATE)
    messages = [
        Recorded("/tf", channel, at, None, transforms(store, at))
        for at in range(10**12, 10**12 + TAKEN * period, period)
    ]
    decode = Decoding(MessageTypes([])).transforms
    topics = TransformTopics(FrameHistory(), ("/tf",), (), decode)
    start = time.process_time()
    for message in messages:
        topics.take(message)
    each = (time.process_time() - start) / TAKEN
    print(f"\n{FRAMES} transforms: {each * 1e6:.0f} µs, {each * RATE:.1%} of a core")
    assert len(topics.changed()) == FRAMES
    assert each * RATE < SHARE


def test_what_protobuf_costs_beside_cdr() -> None:
    """The same in both encodings: CDR's clouds are views, Protobuf copies bytes."""
    import foxglove.messages as fox
    from foreign_messages import in_protobuf, recorded
    from rosbags.typesys import Stores, get_typestore

    store, decoding = get_typestore(Stores.ROS2_JAZZY), Decoding(MessageTypes())

    def cdr(name: str, message: object) -> Recorded:
        payload = bytes(store.serialize_cdr(message, name))
        return recorded((Schema(name), "cdr", payload))

    numbers = np.random.default_rng(1).random(1 << 18, np.float32)
    names = ("x", "y", "z", "intensity")
    kind = fox.PackedElementFieldNumericType.Float32
    packed = [
        fox.PackedElementField(name=name, offset=4 * at, type=kind)
        for at, name in enumerate(names)
    ]
    cloud = fox.PointCloud(point_stride=16, fields=packed, data=numbers.tobytes())
    field, head = (
        store.types[f"{name}"]
        for name in ("sensor_msgs/msg/PointField", "std_msgs/msg/Header")
    )
    header = head(stamp=store.types["builtin_interfaces/msg/Time"](0, 0), frame_id="a")
    fields = [field(name, 4 * at, 7, 1) for at, name in enumerate(names)]
    bytes_of = numbers.view(np.uint8)
    size, count = bytes_of.size, numbers.size // 4
    cloud2 = store.types["sensor_msgs/msg/PointCloud2"](
        header, 1, count, fields, False, 16, size, bytes_of, True
    )
    ranges = numbers[:1080]
    scan = store.types["sensor_msgs/msg/LaserScan"](
        header, 0.0, 1.0, 0.001, 0.0, 0.0, 0.0, 9.0, ranges, np.zeros(0, np.float32)
    )
    pairs = {
        "a cloud of 1 MB": (cdr("sensor_msgs/msg/PointCloud2", cloud2), cloud),
        "a scan of 1080": (
            cdr("sensor_msgs/msg/LaserScan", scan),
            fox.LaserScan(end_angle=1, ranges=ranges.tolist()),
        ),
    }
    print()
    for what, (ours, theirs) in pairs.items():
        other = recorded(in_protobuf(theirs))
        a, b = medians(
            lambda m=ours: decoding.decode(m), lambda m=other: decoding.decode(m)
        )
        print(f"{what}: CDR {a * 1e6:.0f} µs, Protobuf {b * 1e6:.0f} µs")
        # Google's parser copies bytes twice, which costs as much as the memory does.
        assert what.startswith("a cloud") or b / a <= 12, what
    # ROS's own message of as many transforms, by rosbags.
    rows = [
        fox.FrameTransform(
            parent_frame_id=f"robot_link_{n}",
            child_frame_id=f"robot_link_{n + 1}",
            translation=fox.Vector3(x=n, y=0, z=0),
            rotation=fox.Quaternion(x=0, y=0, z=0, w=1),
        )
        for n in range(FRAMES)
    ]
    protobuf = recorded(in_protobuf(fox.FrameTransforms(transforms=rows)))
    payload, name = transforms(store), "tf2_msgs/msg/TFMessage"
    ours, rosbags = medians(
        lambda: decoding.transforms(protobuf),
        lambda: store.deserialize_cdr(payload, name),
    )
    print(f"{FRAMES} transforms: {ours * 1e6:.0f} µs, rosbags {rosbags * 1e6:.0f} µs")
    assert ours <= 4 * rosbags
