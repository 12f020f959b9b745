"""What tf2_echo prints."""

from __future__ import annotations

import math

import pytest

from sambot_viz.commands.echo import echo_json, format_echo
from sambot_viz.frames import FrameTree, Transform

LASER = """\
At time 0.0
- Translation: [0.100, 0.000, 0.200]
- Rotation: in Quaternion [0.000, 0.000, 0.000, 1.000]
- Rotation: in RPY (radian) [0.000, -0.000, 0.000]
- Rotation: in RPY (degree) [0.000, -0.000, 0.000]
- Matrix:
  1.000  0.000  0.000  0.100
  0.000  1.000  0.000  0.000
  0.000  0.000  1.000  0.200
  0.000  0.000  0.000  1.000"""

TURNED = """\
At time 1663059000.5000000
- Translation: [-1.250, 10.500, 100.125]
- Rotation: in Quaternion [0.106, -0.035, 0.706, 0.699]
- Rotation: in RPY (radian) [0.100, -0.200, 1.571]
- Rotation: in RPY (degree) [5.730, -11.459, 90.000]
- Matrix:
 -0.000 -0.995  0.100 -1.250
  0.980 -0.020 -0.198 10.500
  0.199  0.098  0.975 100.125
  0.000  0.000  0.000  1.000"""


def test_the_tutorials_laser_prints_as_tf2_echo_prints_it() -> None:
    tree = FrameTree()
    tree.set_static("base_link", "base_laser", Transform.from_xyz_rpy((0.1, 0, 0.2)))
    assert format_echo(tree.lookup("base_link", "base_laser")) == LASER


def test_signs_of_zero_in_the_input_do_not_show() -> None:
    T = Transform.from_xyz_rpy((0.1, -0.0, 0.2), (-0.0, 0.0, -0.0))
    assert format_echo(T) == LASER


def test_a_turned_frame_prints_as_tf2_echo_prints_it() -> None:
    T = Transform.from_xyz_rpy((-1.25, 10.5, 100.125), (0.1, -0.2, 1.5708))
    assert format_echo(T, time=1663059000.005) == TURNED


def test_at_the_pole_the_angles_are_right_where_tf2_has_noise() -> None:
    T = Transform.from_xyz_rpy(rpy=(0.3, math.pi / 2, 0.4))
    assert "RPY (radian) [-0.100, 1.571, 0.000]" in format_echo(T)


@pytest.mark.parametrize(
    ("time", "text"),
    [(0.0, "0.0"), (12.0, "12.0"), (1.25, "1.250000000"), (3.000001, "3.1000")],
)
def test_nanoseconds_are_not_padded(time: float, text: str) -> None:
    assert format_echo(Transform.identity(), time).startswith(f"At time {text}\n")


def test_json_is_exact() -> None:
    T = Transform.from_xyz_rpy((0.1, 0, 1 / 3), (0, 0, math.pi / 2))
    assert echo_json(T) == {
        "translation": [0.1, 0.0, 1 / 3],
        "rotation_xyzw": T.rotation_xyzw.tolist(),
        "rpy": list(T.rpy),
        "matrix": T.matrix.tolist(),
    }


def test_the_sign_of_a_quaternion_is_that_of_tf2s_product() -> None:
    # Twice 135° makes w negative, where a matrix of -90° would have it positive.
    tree = FrameTree()
    turn = Transform.from_xyz_rpy(rpy=(0, 0, math.radians(135)))
    tree.set("a", "b", turn)
    tree.set("b", "c", turn)
    root = math.sqrt(0.5)
    assert tree.lookup("a", "c").rotation_xyzw == pytest.approx((0, 0, root, -root))
    assert tree.lookup("c", "a").rotation_xyzw == pytest.approx((0, 0, -root, -root))
    assert (turn @ turn).rotation_xyzw == pytest.approx((0, 0, -root, root))


def test_a_given_quaternion_keeps_its_sign() -> None:
    T = Transform.from_xyz_xyzw((0, 0, 0), (0, 0, 0, -1))
    assert T.rotation_xyzw.tolist() == [0, 0, 0, -1]
