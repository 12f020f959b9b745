"""Two sensors of different types with one topic are found, and parted."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL, BRIDGE = "urdf/cart.urdf.xacro", "config/bridge_config.yaml"
CAMERA = """\
  <gazebo reference="base_link">
    <sensor name="camera" type="rgbd_camera">
      <topic>{}</topic>
      <gz_frame_id>base_link</gz_frame_id>
    </sensor>
  </gazebo>
</robot>"""
POINTS = """
- topic_name: /depth_camera/points
  ros_type_name: sensor_msgs/msg/PointCloud2
  gz_type_name: gz.msgs.PointCloudPacked
  direction: GZ_TO_ROS
"""

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("bridged", "topic", "why"),
    [
        (POINTS, "depth_camera", "a bridge expects /depth_camera/points"),
        ("", "camera", "on one topic, scan"),
    ],
)
def test_a_camera_on_the_topic_of_the_lidar(
    copied: Copied, bridged: str, topic: str, why: str
) -> None:
    package = copied("gz")
    model, bridge = package / MODEL, package / BRIDGE
    text = model.read_text()
    bridge.write_text(bridge.read_text() + bridged)
    model.write_text(text.replace("</robot>", CAMERA.format("scan")))
    line = text.count("\n", 0, text.index("</robot>")) + 3

    (problem,) = check(model)

    assert (problem.code, problem.file) == ("sensor-topic-shared", str(model))
    assert problem.line == line
    assert "the sensors lidar (line" in problem.message
    assert why in problem.message
    assert problem.hint == f"write <topic>{topic}</topic>"
    model.write_text(text.replace("</robot>", CAMERA.format(topic)))
    assert check(model) == []


def test_the_lidar_is_named_when_its_topic_is_the_copied_one(copied: Copied) -> None:
    package = copied("gz")
    model, bridge = package / MODEL, package / BRIDGE
    bridge.write_text(bridge.read_text() + POINTS)
    text = model.read_text().replace("</robot>", CAMERA.format("depth_camera"))
    model.write_text(text.replace("<topic>scan", "<topic>depth_camera"))

    problems = check(model)

    assert [p.code for p in problems] == ["sensor-topic-shared"]
    assert problems[0].hint == "write <topic>scan</topic>"
    model.write_text(text)
    assert check(model) == []


def test_two_lidars_may_share_a_topic(copied: Copied) -> None:
    package = copied("gz")
    model = package / MODEL
    other = CAMERA.format("scan").replace("rgbd_camera", "gpu_lidar")
    model.write_text(model.read_text().replace("</robot>", other))
    assert check(model) == []
