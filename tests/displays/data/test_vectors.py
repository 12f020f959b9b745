"""Wrench, TwistStamped and AccelStamped: their arrows, and what they refuse."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sambot_viz.displays.data.vectors import VectorLook, arrow_of, ring_of

Make = Callable[[Any], tuple[str, str, object]]
Open = Callable[..., Any]
Vector = tuple[float, float, float]
NAN = float("nan")
LOOK = VectorLook((204, 51, 51), 1.0, scale=2.0, width=0.5, hides_small=True)
FIELDS = {"Wrench": "Wrench", "TwistStamped": "Twist", "AccelStamped": "Accel"}


def of(kind: str, first: Vector, second: Vector, frame: str = "map") -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        vector = types["geometry_msgs/msg/Vector3"]
        stamp = types["builtin_interfaces/msg/Time"](0, 0)
        header = types["std_msgs/msg/Header"](stamp, frame)
        name = f"geometry_msgs/msg/{FIELDS[kind]}Stamped"
        both = types[name.removesuffix("Stamped")](vector(*first), vector(*second))
        return "/a", name, types[name](header, both)

    return make


def pose(*position: float) -> Any:
    T = np.eye(4)
    T[:3, 3] = position
    return T


def test_an_arrow_is_as_long_as_its_vector_times_the_scale() -> None:
    head, shaft = arrow_of((0.0, 0.0, 3.0), LOOK, pose(1, 2, 3))
    assert shaft.kind == "cylinder"
    assert shaft.scale == pytest.approx((0.05, 0.05, 6.0))
    assert shaft.position == pytest.approx((1, 2, 6))
    assert head.kind == "cone"
    assert head.scale == pytest.approx((0.1, 0.1, 1.8))
    assert head.position == pytest.approx((1, 2, 9.9))


def test_a_vector_that_is_not_longer_than_the_width_is_left_out() -> None:
    short, here = (0.25, 0.0, 0.0), pose(0, 0, 0)
    assert not arrow_of(short, LOOK, here)
    assert not ring_of(short, LOOK, here)
    shows_all = VectorLook((0, 0, 0), 1.0, 2.0, 0.5, hides_small=False)
    assert len(arrow_of(short, shows_all, here)) == 2
    assert not arrow_of((0.0, 0.0, 0.0), shows_all, here)


@pytest.mark.parametrize("vector", [(0.0, 0.0, 2.0), (0.0, 0.0, -2.0), (1.0, 2.0, 3.0)])
def test_the_circle_turns_about_its_vector(vector: Vector) -> None:
    """An eighth is open; the head is at the end of what turns counter-clockwise."""
    (ring,) = ring_of(vector, LOOK, pose(1, 1, 1))
    length = 2 * math.hypot(*vector)
    unit = 2 * np.array(vector) / length
    arms = ring.points - ring.middle
    assert ring.middle == pytest.approx(1 + unit * length / 2)
    assert (arms**2).sum(axis=1) == pytest.approx(np.full(29, (length / 4) ** 2))
    assert arms @ unit == pytest.approx(np.zeros(29))
    turns = np.cross(arms[:-1], arms[1:]) @ unit
    assert (turns > 0).all()
    begin, end = arms[0], arms[-1]
    assert begin @ end == pytest.approx(np.cos(np.pi / 4) * (length / 4) ** 2)
    assert np.cross(end, ring.to_quarter) @ unit == pytest.approx((length / 4) ** 2)
    (head,) = ring.tip
    assert head.scale == pytest.approx((0.1, 0.1, 0.05))


def test_the_circle_about_minus_z_begins_where_rvizs_does() -> None:
    (ring,) = ring_of((0.0, 0.0, -1.0), LOOK, pose(0, 0, 0))
    assert ring.to_head == pytest.approx((-0.5, 0, 0))
    assert ring.to_quarter == pytest.approx((0, 0.5, 0))


@pytest.mark.parametrize("kind", list(FIELDS))
def test_two_arrows_and_a_circle_are_three_nodes(messages: Open, kind: str) -> None:
    shown = messages(kind, of(kind, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    parts = [name.rpartition("_")[2] for name in shown.node_names()]
    assert parts == ["r", "sco", "scy"]
    assert shown.statuses == {
        "Topic": ("Ok", "1 messages received at 0.0 hz."),
        "Transform": ("Ok", "Transform OK"),
    }
    shown.set("Arrow Width", 3)
    assert shown.node_names() == []


def test_small_velocities_are_shown_when_they_are_not_hidden(messages: Open) -> None:
    small = of("TwistStamped", (0.1, 0.0, 0.0), (0.0, 0.0, 0.1))
    shown = messages("TwistStamped", small)
    assert shown.node_names() == []
    shown.set("Hide Small Values", False)
    assert len(shown.node_names()) == 3


def solids(shown: Any) -> int:
    """So many cones it shows; each pair of vectors has three."""
    scene = shown.viz.viser.scene
    (name,) = (name for name in shown.node_names() if name.endswith("sco"))
    return len(scene._handle_from_node_name[name].batched_positions)


def test_older_messages_stay_up_to_the_history_length(messages: Open) -> None:
    made = [of("Wrench", (n + 1.0, 0.0, 0.0), (1.0, 0.0, 0.0)) for n in range(5)]
    shown = messages("Wrench", *made, **{"History Length": 3})
    assert solids(shown) == 9
    shown.set("History Length", 1)
    assert solids(shown) == 3


@pytest.mark.parametrize("bad", [NAN, float("inf"), 1e300])
@pytest.mark.parametrize("kind", list(FIELDS))
def test_a_vector_that_is_no_number_is_refused(
    messages: Open, kind: str, bad: float
) -> None:
    shown = messages(kind, of(kind, (1.0, 0.0, 0.0), (0.0, bad, 0.0)))
    text = "Message contained invalid floating point values (nans or infs)"
    assert shown.statuses["Topic"] == ("Error", text)
    assert shown.node_names() == []


def test_what_is_nan_of_a_wrench_may_be_zero(messages: Open) -> None:
    shown = messages("Wrench", of("Wrench", (1.0, NAN, 0.0), (NAN, NAN, NAN)))
    assert shown.statuses["Topic"][0] == "Error"
    shown.set("Accept NaN Values", True)
    assert solids(shown) == 1
    assert shown.statuses["Topic"][0] == "Ok"
    shown.set("Accept NaN Values", False)
    assert shown.statuses["Topic"][0] == "Error"
    assert shown.node_names() == []


def test_infinity_is_refused_where_nan_is_not(messages: Open) -> None:
    made = of("Wrench", (float("inf"), 0.0, 0.0), (0.0, 0.0, 0.0))
    shown = messages("Wrench", made, **{"Accept NaN Values": True})
    assert shown.statuses["Topic"][0] == "Error"
