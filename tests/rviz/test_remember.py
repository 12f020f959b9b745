"""Putting a property back: its value, and the way in which the file writes it."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from sambot_viz.rviz import BoolProperty, EntryItem, FloatProperty, RvizConfig
from sambot_viz.rviz.changes import remembered

OneDisplay = Callable[[str], RvizConfig]
BOX = BoolProperty("Value", default=True)
ALPHA = FloatProperty("Alpha", default=1.0)


@pytest.mark.parametrize(
    ("lines", "path", "value"),
    [
        ("Alpha: 0.50  # half", "Alpha", 0.25),
        ("Name: g", "Alpha", 0.25),
        ("Line Style:\n  Line Width: 0.03\n  Value: Lines", "Line Style", "Billboards"),
        ("Line Style: Lines", "Line Style", "Billboards"),
        ("Offset: {X: 1, Y: 2, Z: 3}", "Offset", (0.0, 2.0, 4.0)),
        ("Offset:\n  X: 1\n  Y: 2\n  Z: 3", "Offset", (0.0, 2.0, 4.0)),
        ("Name: g", "Offset", (0.0, 2.0, 4.0)),
        ("Line Style:\n  Value: Lines", "Line Style/Line Width", 0.5),
        ("Alpha: nothing", "Alpha", 0.25),
    ],
)
def test_a_value_is_written_again_as_it_was(
    one_display: OneDisplay, lines: str, path: str, value: object
) -> None:
    config = one_display(f"Class: rviz_default_plugins/Grid\n{lines}")
    (grid,) = config.displays
    before, given = grid.get(path), grid.is_given(path)
    text = config.to_yaml()
    with remembered() as changes:
        grid.set(path, value)
        grid.set(path, value)
    assert changes
    changed = config.to_yaml()
    for _ in range(2):
        changes.undo()
        assert (grid.get(path), grid.is_given(path)) == (before, given)
        assert config.to_yaml() == text
        changes.redo()
        assert grid.get(path) == value
        assert config.to_yaml() == changed


@pytest.mark.parametrize(
    "lines", ["Links:\n  All: true", "Links:\n  base: false  # off"]
)
def test_an_entry_is_written_again_as_it_was(
    one_display: OneDisplay, lines: str
) -> None:
    config = one_display(f"Class: rviz_default_plugins/RobotModel\n{lines}")
    (robot,) = config.displays
    text = config.to_yaml()
    base = EntryItem(robot, ("Links", "base"), (BOX, ALPHA))
    box = base.get("Value")
    with remembered() as changes:
        base.set("Alpha", 0.5)
        base.set("Value", not box)
    changes.undo()
    assert (base.get("Alpha"), base.get("Value")) == (1.0, box)
    assert config.to_yaml() == text
    changes.redo()
    again = EntryItem(robot, ("Links", "base"), (BOX, ALPHA))
    assert (again.get("Alpha"), again.get("Value")) == (0.5, not box)


def test_values_that_were_set_meanwhile_stay(one_display: OneDisplay) -> None:
    config = one_display(
        "Class: rviz_default_plugins/RobotModel\nLinks:\n  base: false"
    )
    (robot,) = config.displays
    base, hand = (
        EntryItem(robot, ("Links", name), (BOX, ALPHA)) for name in ("base", "hand")
    )
    with remembered() as of_box:
        base.set("Value", True)
        hand.set("Value", False)
    base.set("Alpha", 0.5)
    hand.set("Alpha", 0.25)
    of_box.undo()
    assert robot.dynamic("Links") == {
        "base": {"Alpha": "0.5", "Value": "false"},
        "hand": {"Alpha": "0.25"},
    }


def test_nothing_is_remembered_of_a_value_that_stays(one_display: OneDisplay) -> None:
    (grid,) = one_display("Class: rviz_default_plugins/Grid\nAlpha: 0.5").displays
    with remembered() as changes:
        grid.set("Alpha", 0.5)
    assert not changes
