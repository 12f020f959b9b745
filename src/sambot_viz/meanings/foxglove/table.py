"""The table of Foxglove's schemas: what each means, and how its fields are called."""

from __future__ import annotations

from collections.abc import Mapping, Sized
from typing import Any

import numpy as np

from sambot_viz.errors import DecodeError
from sambot_viz.meanings.foxglove import packed, scene_update
from sambot_viz.meanings.foxglove.common_parts import (
    header_of,
    part,
    parts,
    pose_of,
    rotation_of,
    time_of,
)
from sambot_viz.meanings.meaning import Meaning
from sambot_viz.meanings.schema_row import SENSOR_POSE, Fields, SchemaRow
from sambot_viz.messages.shape import real_number

_LEVELS = (0, 10, 20, 30, 40, 50)
"""ROS's number of a level for each of Foxglove's: unknown, debug, …, fatal."""
_ENCODINGS = {"uyvy": "yuv422", "yuyv": "yuv422_yuy2"}
"""Encodings of images that have another name in ROS."""


def _transform(fields: Fields) -> Fields:
    header = {
        "stamp": time_of(fields.get("timestamp")),
        "frame_id": fields.get("parent_frame_id"),
    }
    return {
        "header": header,
        "child_frame_id": fields.get("child_frame_id"),
        "transform": {
            "translation": fields.get("translation"),
            "rotation": rotation_of(part(fields, "rotation")),
        },
    }


def _one_transform(fields: Fields) -> Fields:
    return {"transforms": [_transform(fields)]}


def _transforms(fields: Fields) -> Fields:
    return {"transforms": [_transform(one) for one in parts(fields, "transforms")]}


def _joints(fields: Fields) -> Fields:
    return _joint_states(fields.get("timestamp"), parts(fields, "joints"))


def _one_joint(fields: Fields) -> Fields:
    return _joint_states(None, [fields])


def _joint_states(stamp: Any, joints: Any) -> Fields:
    def of(name: str) -> list[Any]:
        values = [one.get(name) for one in joints]
        known = any(value is not None for value in values)
        return [np.nan if value is None else value for value in values] if known else []

    names = [one.get("name") for one in joints]
    found: dict[str, Any] = {"header": {"stamp": time_of(stamp)}, "name": names}
    found["position"] = of("position") or [np.nan] * len(names)
    return {**found, "velocity": of("velocity"), "effort": of("effort")}


def _scan(fields: Fields) -> Fields:
    ranges: Any = fields.get("ranges")
    count = len(ranges) if isinstance(ranges, Sized) else 0
    first, last = (real_number(fields.get(f"{end}_angle")) for end in ("start", "end"))
    return {
        "header": header_of(fields),
        SENSOR_POSE: part(fields, "pose"),
        "angle_min": first,
        "angle_max": last,
        "angle_increment": (last - first) / max(count - 1, 1),
        "range_max": np.inf,
        "ranges": ranges,
        "intensities": fields.get("intensities"),
    }


def _pose(fields: Fields) -> Fields:
    return {"header": header_of(fields), "pose": pose_of(part(fields, "pose"))}


def _poses(fields: Fields) -> Fields:
    poses = [pose_of(one) for one in parts(fields, "poses")]
    return {"header": header_of(fields), "poses": poses}


def _point(fields: Fields) -> Fields:
    return {"header": header_of(fields), "point": part(fields, "point")}


def _odometry(fields: Fields) -> Fields:
    twist = {
        "linear": part(fields, "linear_velocity"),
        "angular": part(fields, "angular_velocity"),
    }
    return {
        "header": header_of(fields),
        "child_frame_id": fields.get("body_frame_id"),
        "pose": {
            "pose": pose_of(part(fields, "pose")),
            "covariance": fields.get("pose_covariance"),
        },
        "twist": {"twist": twist, "covariance": fields.get("velocity_covariance")},
    }


def _raw_image(fields: Fields) -> Fields:
    encoding = fields.get("encoding")
    found = {name: fields.get(name) for name in ("width", "height", "step", "data")}
    known = encoding if not isinstance(encoding, str) else _ENCODINGS.get(encoding)
    return {"header": header_of(fields), "encoding": known or encoding, **found}


def _image_file(fields: Fields) -> Fields:
    found = {name: fields.get(name) for name in ("format", "data")}
    return {"header": header_of(fields), **found}


def _camera(fields: Fields) -> Fields:
    names = ("width", "height", "distortion_model")
    found = {name: fields.get(name) for name in names}
    matrices = {name.lower(): fields.get(name) for name in "DKRP"}
    k, p = matrices["k"], matrices["p"]
    if k is not None and len(k) == 9 and (p is None or not len(p)):
        matrices["p"] = [*k[:3], 0.0, *k[3:6], 0.0, *k[6:], 0.0]
    return {"header": header_of(fields), **found, **matrices}


def _location(fields: Fields) -> Fields:
    names = ("latitude", "longitude", "altitude", "position_covariance")
    found = {name: fields.get(name) for name in names}
    known = fields.get("position_covariance_type")
    header = header_of(fields)
    return {"header": header, **found, "position_covariance_type": known}


def _log(fields: Fields) -> Fields:
    level = fields.get("level")
    known = isinstance(level, int) and 0 <= level < len(_LEVELS)
    return {
        "stamp": time_of(fields.get("timestamp")),
        "level": _LEVELS[level] if known and isinstance(level, int) else 0,
        "msg": fields.get("message"),
        **{name: fields.get(name) for name in ("name", "file", "line")},
    }


def _compressed_cloud(fields: Fields) -> Fields:
    kind = fields.get("format") or "an unknown format"
    raise DecodeError(f"its points are compressed ({kind}), which is not read")


FOXGLOVE: Mapping[str, SchemaRow] = {
    "foxglove.FrameTransform": SchemaRow(Meaning.TRANSFORMS, _one_transform),
    "foxglove.FrameTransforms": SchemaRow(Meaning.TRANSFORMS, _transforms),
    "foxglove.JointState": SchemaRow(Meaning.JOINTS, _one_joint),
    "foxglove.JointStates": SchemaRow(Meaning.JOINTS, _joints),
    "foxglove.PointCloud": SchemaRow(Meaning.CLOUD, packed.cloud),
    "foxglove.CompressedPointCloud": SchemaRow(Meaning.CLOUD, _compressed_cloud),
    "foxglove.VoxelGrid": SchemaRow(Meaning.CLOUD, packed.voxels),
    "foxglove.LaserScan": SchemaRow(Meaning.SCAN, _scan),
    "foxglove.Grid": SchemaRow(Meaning.GRID, packed.grid),
    "foxglove.PoseInFrame": SchemaRow(Meaning.POSE, _pose),
    "foxglove.PosesInFrame": SchemaRow(Meaning.POSES, _poses),
    "foxglove.Point3InFrame": SchemaRow(Meaning.POINT, _point),
    "foxglove.Odometry": SchemaRow(Meaning.ODOMETRY, _odometry),
    "foxglove.SceneUpdate": SchemaRow(Meaning.MARKERS, scene_update.markers),
    "foxglove.RawImage": SchemaRow(Meaning.IMAGE, _raw_image),
    "foxglove.CompressedImage": SchemaRow(Meaning.IMAGE_FILE, _image_file),
    "foxglove.CompressedVideo": SchemaRow(Meaning.IMAGE_FILE, _image_file),
    "foxglove.CameraCalibration": SchemaRow(Meaning.CAMERA, _camera),
    "foxglove.LocationFix": SchemaRow(Meaning.PLACE_ON_EARTH, _location),
    "foxglove.Log": SchemaRow(Meaning.LOG, _log),
}
