"""Foxglove's schemas have the look of the ROS types of their meaning.

The messages are written by foxglove-sdk, as JSON by hand where encodings differ.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import foxglove.messages as fox
import numpy as np
import pytest
from foreign_messages import Channel, in_json, in_protobuf, recorded

from sambot_viz.messages import MessageTypes
from sambot_viz.topics.decoding import Decoding

Decode = Callable[[Channel], Any]
STAMP = fox.Timestamp(sec=12, nsec=34)


def placed(**values: Any) -> dict[str, Any]:
    pose = fox.Pose(
        position=fox.Vector3(x=1, y=2, z=3),
        orientation=fox.Quaternion(x=0, y=0, z=1, w=0),
    )
    return {"timestamp": STAMP, "frame_id": "lidar", "pose": pose, **values}


def header(message: Any) -> tuple[str, int, int]:
    head = message.header
    return head.frame_id, head.stamp.sec, head.stamp.nanosec


def test_a_transform_without_a_rotation_does_not_turn() -> None:
    transform = fox.FrameTransform(
        timestamp=STAMP,
        parent_frame_id="map",
        child_frame_id="odom",
        translation=fox.Vector3(x=1, y=0, z=-2),
    )
    both = fox.FrameTransforms(transforms=[transform])
    decoding = Decoding(MessageTypes())
    for channel in (in_protobuf(transform), in_protobuf(both)):
        ((stamp, edges, poses),) = decoding.transforms(recorded(channel))
        assert (stamp, edges) == (12_000_000_034, (("map", "odom"),))
        assert poses.tolist() == [[1, 0, -2, 0, 0, 0, 1]]
        # Those who take them know frames that come again by this.
        assert decoding.transforms(recorded(channel))[0][1] is edges


def test_transforms_in_json_are_those_in_protobuf() -> None:
    decoding = Decoding(MessageTypes())
    fields = {
        "timestamp": {"sec": 12, "nsec": 34},
        "parent_frame_id": "map",
        "child_frame_id": "odom",
        "translation": {"x": 1, "y": 0, "z": -2},
        "rotation": {"x": 0, "y": 0, "z": 0.6, "w": 0.8},
    }
    channel = in_json("foxglove.FrameTransform", fields)
    ((stamp, edges, poses),) = decoding.transforms(recorded(channel))
    assert (stamp, edges) == (12_000_000_034, (("map", "odom"),))
    assert poses.tolist() == [[1, 0, -2, 0, 0, 0.6, 0.8]]


def test_a_scan_has_its_readings_between_its_first_and_last_bearing(
    decode: Decode,
) -> None:
    scan = fox.LaserScan(
        **placed(start_angle=-1, end_angle=1, ranges=[1, 2, 3], intensities=[4, 5, 6])
    )
    message = decode(in_protobuf(scan))
    assert header(message) == ("lidar", 12, 34)
    assert (message.angle_min, message.angle_increment) == (-1, 1)
    assert message.ranges.tolist() == [1, 2, 3]
    assert message.intensities.tolist() == [4, 5, 6]
    assert message.range_min == 0 and message.range_max == np.inf
    pose = message.sensor_pose
    assert (pose.position.y, pose.orientation.z, pose.orientation.w) == (2, 1, 0)


F32 = fox.PackedElementFieldNumericType.Float32
F64 = fox.PackedElementFieldNumericType.Float64
BYTE = fox.PackedElementFieldNumericType.Uint8


def cloud_of(table: Any, kinds: Any) -> Any:
    """A foxglove.PointCloud of a structured array."""
    fields = [
        fox.PackedElementField(name=name, offset=table.dtype.fields[name][1], type=kind)
        for name, kind in kinds.items()
    ]
    stride = table.dtype.itemsize
    values = placed(point_stride=stride, fields=fields, data=table.tobytes())
    return fox.PointCloud(**values)


def columns(message: Any) -> dict[str, list[float]]:
    """The values of all fields of a sensor_msgs/PointCloud2, read anew."""
    kinds = {1: "i1", 2: "u1", 3: "<i2", 4: "<u2", 5: "<i4", 6: "<u4", 7: "<f4"}
    kinds[8] = "<f8"
    kind: Any = {
        "names": [one.name for one in message.fields],
        "formats": [kinds[one.datatype] for one in message.fields],
        "offsets": [one.offset for one in message.fields],
        "itemsize": message.point_step,
    }
    rows = np.frombuffer(bytes(message.data), np.dtype(kind))
    assert len(rows) == message.width * message.height
    return {name: rows[name].tolist() for name in rows.dtype.names or ()}


def test_a_cloud_that_ros_packs_alike_is_a_view_of_its_message(decode: Decode) -> None:
    table = np.array([(1, 2, 3, 9), (4, 5, 6, 8)], "f4,f4,f4,u1")
    table.dtype.names = ("x", "y", "z", "ring")
    cloud = cloud_of(table, {"x": F32, "y": F32, "z": F32, "ring": BYTE})
    message = decode(in_protobuf(cloud))
    assert header(message) == ("lidar", 12, 34)
    assert message.point_step == table.dtype.itemsize
    assert columns(message) == {"x": [1, 4], "y": [2, 5], "z": [3, 6], "ring": [9, 8]}
    assert message.data.base is not None and not message.data.flags.writeable


def test_coordinates_of_any_kind_are_brought_into_rvizs(decode: Decode) -> None:
    table = np.array([(1.5, -2), (4, 5)], "f8,i2")
    table.dtype.names = ("x", "y")
    short = fox.PackedElementFieldNumericType.Int16
    message = decode(in_protobuf(cloud_of(table, {"x": F64, "y": short})))
    assert columns(message) == {"x": [1.5, 4], "y": [-2, 5], "z": [0, 0]}
    assert {one.datatype for one in message.fields} == {7}


def test_colours_in_fields_of_their_own_become_rvizs_field(decode: Decode) -> None:
    names = ("x", "y", "z", "red", "green", "blue", "alpha")
    table = np.array([(0, 0, 0, 1, 2, 3, 255)], "f4,f4,f4,u1,u1,u1,u1")
    table.dtype.names = names
    kinds = {name: F32 if name in "xyz" else BYTE for name in names}
    found = columns(decode(in_protobuf(cloud_of(table, kinds))))
    assert found["rgb"] == [0x010203]


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"point_stride": 0}, "point_stride is 0"),
        ({"point_stride": 7}, "its 8 bytes are not points of 7 bytes"),
        ({"fields": []}, "it has no two of the fields x, y and z"),
    ],
)
def test_a_cloud_that_contradicts_itself_is_refused(
    decode: Decode, values: dict[str, Any], why: str
) -> None:
    fields = [
        fox.PackedElementField(name=name, offset=at, type=F32)
        for name, at in (("x", 0), ("y", 4))
    ]
    good = {"point_stride": 8, "fields": fields, "data": bytes(8)}
    with pytest.raises(Exception, match=why):
        decode(in_protobuf(fox.PointCloud(**placed(**{**good, **values}))))


def grid_of(cells: Any, **values: Any) -> Any:
    kinds = {"i1": fox.PackedElementFieldNumericType.Int8, "f4": F32, "u1": BYTE}
    kind = kinds[cells.dtype.str[1:]]
    size, columns = cells.dtype.itemsize, cells.shape[1]
    given = {
        "column_count": columns,
        "cell_size": fox.Vector2(x=0.5, y=0.5),
        "row_stride": columns * size,
        "cell_stride": size,
        "fields": [fox.PackedElementField(name="v", offset=0, type=kind)],
        "data": cells.tobytes(),
    }
    return fox.Grid(**placed(**{**given, **values}))


def test_a_grid_is_a_map_with_its_origin(decode: Decode) -> None:
    message = decode(in_protobuf(grid_of(np.array([[0, 100, -1], [1, 2, 3]], "i1"))))
    info = message.info
    assert (info.width, info.height, info.resolution) == (3, 2, 0.5)
    assert info.origin.position.y == 2
    assert message.data.tolist() == [0, 100, -1, 1, 2, 3]


def test_values_of_a_grid_are_shades_from_the_least_to_the_greatest(
    decode: Decode,
) -> None:
    cells = np.array([[-5, np.nan], [0, 5]], "f4")
    assert decode(in_protobuf(grid_of(cells))).data.tolist() == [0, -1, 50, 100]


def test_what_is_behind_the_cells_of_a_row_is_left_out(decode: Decode) -> None:
    cells = np.array([[1, 2, 77], [3, 4, 77]], "i1")
    message = decode(in_protobuf(grid_of(cells, column_count=2)))
    assert message.data.tolist() == [1, 2, 3, 4]


def test_cells_that_are_no_squares_are_refused(decode: Decode) -> None:
    grid = grid_of(np.zeros((1, 1), "i1"), cell_size=fox.Vector2(x=0.5, y=1))
    with pytest.raises(Exception, match=r"0\.5 × 1 m, and only squares are drawn"):
        decode(in_protobuf(grid))


def test_voxels_are_points_in_the_middle_of_cells_that_are_not_empty(
    decode: Decode,
) -> None:
    cells = np.zeros((2, 3, 4), "u1")
    cells[1, 2, 3] = 7
    grid = fox.VoxelGrid(
        **placed(
            row_count=3,
            column_count=4,
            cell_size=fox.Vector3(x=1, y=10, z=100),
            slice_stride=12,
            row_stride=4,
            cell_stride=1,
            fields=[fox.PackedElementField(name="v", offset=0, type=BYTE)],
            data=cells.tobytes(),
        )
    )
    found = columns(decode(in_protobuf(grid)))
    assert found == {"x": [3.5], "y": [25], "z": [150], "v": [7]}


def test_poses_and_points_have_their_frame(decode: Decode) -> None:
    pose = decode(in_protobuf(fox.PoseInFrame(**placed())))
    assert header(pose) == ("lidar", 12, 34)
    assert (pose.pose.position.x, pose.pose.orientation.z) == (1, 1)
    given = placed()
    given["poses"] = [given.pop("pose"), fox.Pose()]
    poses = decode(in_protobuf(fox.PosesInFrame(**given))).poses
    assert [one.position.z for one in poses] == [3, 0]
    assert [one.orientation.w for one in poses] == [0, 1]
    del given["poses"]
    point = fox.Point3InFrame(**given, point=fox.Point3(x=1, y=2, z=3))
    assert decode(in_protobuf(point)).point.y == 2


def test_odometry_has_the_twist_of_its_body(decode: Decode) -> None:
    odometry = fox.Odometry(
        **placed(
            body_frame_id="base",
            linear_velocity=fox.Vector3(x=0.5, y=0, z=0),
            pose_covariance=[float(n) for n in range(36)],
        )
    )
    message = decode(in_protobuf(odometry))
    assert (header(message)[0], message.child_frame_id) == ("lidar", "base")
    assert message.pose.pose.position.x == 1
    assert message.pose.covariance[35] == 35
    assert message.twist.twist.linear.x == 0.5
    assert not message.twist.covariance.any()


def test_joints_without_a_position_bring_none(decode: Decode) -> None:
    joints = fox.JointStates(
        timestamp=STAMP,
        joints=[
            fox.JointState(name="a", position=0),
            fox.JointState(name="b", effort=2),
        ],
    )
    message = decode(in_protobuf(joints))
    assert message.name == ["a", "b"]
    assert message.position[0] == 0 and np.isnan(message.position[1])
    assert message.effort[1] == 2 and not len(message.velocity)


def test_images_have_ros_words_for_their_encoding(decode: Decode) -> None:
    given = {"timestamp": STAMP, "frame_id": "cam", "data": bytes(range(8))}
    raw = fox.RawImage(**given, width=2, height=2, encoding="uyvy", step=4)
    message = decode(in_protobuf(raw))
    assert (message.encoding, message.width, message.step) == ("yuv422", 2, 4)
    assert bytes(message.data) == bytes(range(8))
    file = decode(in_protobuf(fox.CompressedImage(**given, format="png")))
    assert (file.format, bytes(file.data)) == ("png", bytes(range(8)))
    # Base64 is how bytes are written in JSON.
    fields = {"frame_id": "cam", "format": "jpeg", "data": "AAEC"}
    assert bytes(decode(in_json("foxglove.CompressedImage", fields)).data) == b"\0\1\2"


def test_a_camera_without_a_projection_has_that_of_its_matrix(decode: Decode) -> None:
    k = [100.0, 0, 32, 0, 110, 24, 0, 0, 1]
    camera = fox.CameraCalibration(
        timestamp=STAMP, frame_id="cam", width=64, height=48, K=k, D=[0.1]
    )
    message = decode(in_protobuf(camera))
    assert message.k.tolist() == k
    assert message.p.tolist() == [100, 0, 32, 0, 0, 110, 24, 0, 0, 0, 1, 0]
    assert message.d.tolist() == [0.1] and not message.r.any()


def test_a_place_on_earth_and_a_log_are_read(decode: Decode) -> None:
    fix = fox.LocationFix(
        timestamp=STAMP, frame_id="gps", latitude=48, longitude=11, altitude=500
    )
    message = decode(in_protobuf(fix))
    assert (message.latitude, message.longitude, message.altitude) == (48, 11, 500)
    log = fox.Log(
        timestamp=STAMP, level=fox.LogLevel.Warning, message="hot", name="n", line=3
    )
    said = decode(in_protobuf(log))
    assert (said.level, said.msg, said.name, said.line) == (30, "hot", "n", 3)


def test_compressed_points_and_video_say_so(decode: Decode) -> None:
    cloud = fox.CompressedPointCloud(**placed(data=b"x", format="draco"))
    with pytest.raises(Exception, match=r"compressed \(draco\), which is not read"):
        decode(in_protobuf(cloud))
    video = fox.CompressedVideo(
        timestamp=STAMP, frame_id="cam", data=b"x", format="h264"
    )
    assert decode(in_protobuf(video)).format == "h264"


def calls(work: Callable[[], object]) -> int:
    """How many functions are called, of Python and of C."""
    count = 0

    def note(frame: object, event: str, arg: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


def many(count: int) -> list[Any]:
    """Messages with so many points, readings, cells and pixels."""
    table = np.ones(count, "f8,f8,u1,u1,u1")
    table.dtype.names = ("x", "y", "red", "green", "blue")
    kinds = dict.fromkeys("xy", F64) | dict.fromkeys(("red", "green", "blue"), BYTE)
    return [
        cloud_of(table, kinds),
        fox.LaserScan(**placed(ranges=[1.0] * count)),
        grid_of(np.ones((1, count), "f4")),
        fox.RawImage(width=count, height=1, encoding="mono8", data=bytes(count)),
    ]


def test_nothing_is_done_for_each_point_or_pixel_by_itself(decode: Decode) -> None:
    for few, lots in zip(many(50), many(5000), strict=True):
        small, large = in_protobuf(few), in_protobuf(lots)
        decode(small), decode(large)
        assert calls(lambda c=small: decode(c)) == calls(lambda c=large: decode(c))
