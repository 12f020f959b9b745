"""Putting a property back: its value, and the way in which the file writes it."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence

import pytest

from sambot_viz.rviz import (
    BoolProperty,
    ConfigItem,
    EntryItem,
    FloatProperty,
    RvizConfig,
)
from sambot_viz.rviz.undo_log import UndoLog, record_changes

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
    with record_changes() as changes:
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
    with record_changes() as changes:
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
    with record_changes() as of_box:
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
    with record_changes() as changes:
        grid.set("Alpha", 0.5)
    assert not changes


ENTRIES = (BOX, ALPHA)
FILES = (
    "Class: rviz_default_plugins/Grid",
    "Class: rviz_default_plugins/Grid\nLine Style: 'Lines'  # flat\nOffset:\nAlpha: .5",
    "Class: rviz_default_plugins/Grid\nZ: 1\nOffset: {X: 1, Y: 2.50, Z: 3}\nColor: red"
    "\nLine Style:\n  # thin\n  Line Width: 3e-2\n  Value: Lines\nAlpha: ~",
    "Class: rviz_default_plugins/Grid\nOffset: nothing\nAlpha: [1, 2]\nLine Style: {}\n"
    "Cell Size: &size 2\nReference Frame: *size",
    "Class: rviz_default_plugins/RobotModel",
    "Class: rviz_default_plugins/RobotModel\nAlpha: 1\nLinks:\n  base: false  # off\n"
    "  arm:\n    Alpha: 0.5\n    Show Axes: false\n  hand: {Value: true}\n"
    "Mass Properties:\n  Inertia: true",
    "Class: rviz_default_plugins/RobotModel\nLinks: ~\nMass Properties: {}\nName: 'r'",
)


def random_edit(draw: random.Random, item: ConfigItem, path: str) -> None:
    now = item.get(path)
    if isinstance(now, bool):
        item.set(path, draw.random() < 0.5)
    elif isinstance(now, int | float):
        item.set(
            path, draw.choice([1, 2, now] if isinstance(now, int) else [1, 2.5, now])
        )
    elif isinstance(now, tuple):
        item.set(path, (draw.randrange(3), 2, 0))
    else:
        options = item.declared[path].property.options
        item.set(path, draw.choice(options or ("base", "arm", str(now))))


def items_of(config: RvizConfig) -> list[ConfigItem]:
    (display,) = config.displays
    links = ("base", "arm", "hand") if "Links" in display.declared else ()
    below = [EntryItem(display, ("Links", name), ENTRIES) for name in links]
    return [display, *below, config.global_options]


def state_of(config: RvizConfig, items: Sequence[ConfigItem]) -> object:
    values = [
        (dict(i.properties), [i.is_given(p) for p in i.properties]) for i in items
    ]
    return values, config.to_yaml()


@pytest.mark.parametrize("lines", FILES)
@pytest.mark.parametrize("seed", range(20))
def test_random_edits_are_undone_and_done_again_byte_for_byte(
    one_display: OneDisplay, lines: str, seed: int
) -> None:
    config = one_display(lines)
    text, items, draw = config.to_yaml(), items_of(config), random.Random(seed)
    states, logs = [state_of(config, items)], list[UndoLog]()
    for _ in range(8):
        with record_changes() as log:
            for _ in range(draw.choice([1, 1, 3])):
                item = draw.choice(items)
                random_edit(draw, item, draw.choice(list(item.properties)))
        logs.append(log)
        states.append(state_of(config, items))
    for _ in range(2):
        for log, state in zip(reversed(logs), states[-2::-1], strict=True):
            log.undo()
            assert state_of(config, items) == state
        assert config.to_yaml() == text
        for log, state in zip(logs, states[1:], strict=True):
            log.redo()
            assert state_of(config, items) == state


@pytest.mark.parametrize("lines", FILES)
@pytest.mark.parametrize("seed", range(10))
def test_edits_undone_in_any_order_leave_the_other_ones(
    one_display: OneDisplay, lines: str, seed: int
) -> None:
    config, draw = one_display(lines), random.Random(seed)
    items = items_of(config)
    places = [(i, path) for i, item in enumerate(items) for path in item.properties]
    first = [dict(item.properties) for item in items]
    logs = dict[tuple[int, str], UndoLog]()
    for number, path in draw.sample(places, min(10, len(places))):
        with record_changes() as logs[number, path]:
            random_edit(draw, items[number], path)
    expected = [dict(item.properties) for item in items]
    for place in draw.sample(list(logs), len(logs)):
        logs[place].undo()
        number, path = place
        expected[number][path] = first[number][path]
        assert [dict(item.properties) for item in items] == expected
        for item, read in zip(items, items_of(config.copy()), strict=True):
            for path, declared in item.declared.items():
                if path in item.properties:
                    assert declared.property.agrees(read.get(path), item.get(path))
    assert expected == first
