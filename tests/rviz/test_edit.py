from __future__ import annotations

import difflib
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.rviz import Declarations, DisplayConfig, RvizConfig
from sambot_viz.rviz.yaml.yaml_nodes import Plain

Parse = Callable[[str], RvizConfig]

TREE = """\
# The lab's robot.
Visualization Manager:
  Displays:
    # the floor
    - Class: rviz_default_plugins/Grid
      Name: a  # first

    # all sensors
    - Class: rviz_common/Group
      Name: g
      Displays:
        # in the group
        - Class: rviz_default_plugins/Grid
          Name: b
          Offset:
            X: 1
            Y: 2
            Z: 3
        - Name: c
          Class: my_plugins/Radar
    - Class: rviz_default_plugins/TF
      Name: d
  Name: root
"""


def names(displays: tuple[DisplayConfig, ...]) -> list[Any]:
    """The names; a group is (name, members)."""
    return [
        (d.name, names(d.displays)) if d.kind == "rviz_common/Group" else d.name
        for d in displays
    ]


def lines(before: str, after: str) -> tuple[list[str], list[str]]:
    """The lines that are gone and those that are new."""
    found = list(difflib.ndiff(before.splitlines(), after.splitlines()))
    gone = [line[2:] for line in found if line.startswith("- ")]
    return gone, [line[2:] for line in found if line.startswith("+ ")]


def reread(config: RvizConfig, declarations: Declarations) -> RvizConfig:
    """What another program finds in the saved file."""
    return RvizConfig.parse(config.to_yaml(), declarations)


def test_a_display_is_added_with_the_defaults_in_rviz_s_order(
    parse: Parse, declarations: Declarations
):
    config = parse(TREE)
    added = config.add_display("rviz_default_plugins/Grid", "new")
    assert added.enabled
    assert added.get("Alpha") == 0.5
    gone, new = lines(TREE, config.to_yaml())
    assert gone == []
    assert new == [
        "    - Alpha: 0.5",
        "      Cell Size: 1",
        "      Class: rviz_default_plugins/Grid",
        "      Color: 160; 160; 164",
        "      Enabled: true",
        "      Line Style:",
        "        Line Width: 0.029999999329447746",
        "        Value: Lines",
        "      Name: new",
        "      Normal Cell Count: 0",
        "      Offset:",
        "        X: 0",
        "        Y: 0",
        "        Z: 0",
        "      Plane: XY",
        "      Plane Cell Count: 10",
        "      Reference Frame: <Fixed Frame>",
        "      Value: true",
    ]
    assert names(reread(config, declarations).displays)[-1] == "new"
    added.set("Alpha", 0.25)
    assert reread(config, declarations).displays[-1].get("Alpha") == 0.25


def test_a_display_is_added_behind_another_and_into_a_group(
    parse: Parse, declarations: Declarations
):
    config = parse(TREE)
    first, group, _ = config.displays
    config.add_display("rviz_default_plugins/TF", after=first)
    config.add_display("rviz_default_plugins/Axes", group=group)
    config.add_display("rviz_common/Group", "h", group=group, after=group.displays[0])
    wanted: list[Any] = ["a", "TF", ("g", ["b", ("h", []), "c", "Axes"]), "d"]
    assert names(config.displays) == wanted
    assert names(reread(config, declarations).displays) == wanted


def test_a_group_is_saved_without_a_value(parse: Parse):
    config = parse("Panels: []\n")
    group = config.add_display("rviz_common/Group")
    config.add_display("rviz_default_plugins/TF", "x", group=group)
    assert list(group.raw) == ["Class", "Displays", "Enabled", "Name"]


def test_a_removed_display_is_put_back_where_it_was(parse: Parse) -> None:
    config = parse(TREE)
    group = config.displays[1]
    first, inner = config.displays[0], group.displays[0]
    for display in (inner, group, first):
        removed = config.remove(display)
        assert not config.holds(display)
        config.put_back(removed)
        assert config.holds(display)
        assert not config.modified
        assert config.to_yaml() == TREE
    of_inner = config.remove(inner)
    config.remove(group)
    with pytest.raises(UsageError, match="is no longer in this config"):
        config.put_back(of_inner)


def test_a_removed_display_takes_its_lines_and_comment_with_it(
    parse: Parse, declarations: Declarations
):
    config = parse(TREE)
    config.remove(config.displays[1])
    assert config.to_yaml() == TREE.replace(
        TREE[
            TREE.index("\n    # all sensors") : TREE.index(
                "    - Class: rviz_default_plugins/TF"
            )
        ],
        "",
    )
    config.remove(config.displays[0])
    config.remove(config.displays[0])
    assert config.displays == ()
    assert "  Displays: ~\n" in config.to_yaml()
    config.add_display("rviz_default_plugins/TF", "t")
    assert names(reread(config, declarations).displays) == ["t"]


def test_a_removed_display_cannot_be_removed_again(parse: Parse):
    config = parse(TREE)
    first = config.displays[0]
    config.remove(first)
    with pytest.raises(UsageError, match=r"'a' .* is not in this config"):
        config.remove(first)


def test_a_duplicate_stands_behind_its_original_and_lives_by_itself(
    parse: Parse, declarations: Declarations
):
    config = parse(TREE)
    b = config.displays[1].displays[0]
    copy = config.duplicate(b)
    copy.set("Offset", (1, 2, 4))
    copy.rename("b2")
    assert b.get("Offset") == (1.0, 2.0, 3.0)
    assert names(config.displays) == ["a", ("g", ["b", "b2", "c"]), "d"]
    gone, new = lines(TREE, config.to_yaml())
    assert gone == []
    assert new == [
        "        - Class: rviz_default_plugins/Grid",
        "          Name: b2",
        "          Offset:",
        "            X: 1",
        "            Y: 2",
        "            Z: 4",
    ]
    again = config.duplicate(config.displays[1])
    assert names((again,)) == [("g", ["b", "b2", "c"])]
    assert names(reread(config, declarations).displays) == names(config.displays)


def test_what_is_doubtful_is_told_once_however_often_it_is_copied(parse: Parse):
    config = parse(TREE.replace("Name: a  # first", "Alpha: 7"))
    assert len(config.problems) == 1
    copy = config.duplicate(config.displays[0])
    assert copy.get("Alpha") == 1.0
    assert len(config.problems) == 1


def test_a_display_moves_with_its_comments(parse: Parse, declarations: Declarations):
    config = parse(TREE)
    a, group, d = config.displays
    config.move(d, 0)
    assert names(config.displays) == ["d", "a", ("g", ["b", "c"])]
    text = config.to_yaml()
    assert text.index("Name: d") < text.index("Name: a  # first")
    config.move(a, 1, group)
    b = group.displays[0]
    config.move(b, 0)
    assert names(config.displays) == ["b", "d", ("g", ["a", "c"])]
    assert names(reread(config, declarations).displays) == names(config.displays)
    assert a.parent is group
    assert b.parent is None
    text = config.to_yaml()
    for comment in ("# the floor", "# first", "# all sensors", "# The lab's robot."):
        assert comment in text
    assert "    # in the group\n    - Class: rviz_default_plugins/Grid\n" in text


def test_a_group_cannot_go_into_itself(parse: Parse):
    config = parse(TREE)
    group = config.displays[1]
    inner = config.add_display("rviz_common/Group", "inner", group=group)
    for target in (group, inner):
        with pytest.raises(UsageError, match="cannot be moved into itself"):
            config.move(group, 0, target)
    with pytest.raises(UsageError, match="is not a group"):
        config.move(group, 0, config.displays[0])
    assert names(config.displays) == ["a", ("g", ["b", "c", ("inner", [])]), "d"]


def test_a_display_cannot_be_added_behind_one_of_another_group(parse: Parse):
    config = parse(TREE)
    with pytest.raises(UsageError, match="is not in that group"):
        config.add_display(
            "rviz_default_plugins/TF",
            group=config.displays[1],
            after=config.displays[0],
        )


def test_moving_back_gives_the_old_file(parse: Parse):
    config = parse(TREE)
    d = config.displays[2]
    config.move(d, 0)
    assert config.modified
    config.move(d, 2)
    assert not config.modified
    assert config.to_yaml() == TREE


def every(displays: tuple[DisplayConfig, ...]) -> Iterator[DisplayConfig]:
    """All displays, groups before their members."""
    for display in displays:
        yield display
        yield from every(display.displays)


def test_one_change_in_a_real_file_shows_as_that_change_only(
    real_files: list[Path], declarations: Declarations
):
    for path in real_files[1::4]:
        before = path.read_text("utf-8")
        config = RvizConfig.load(path, declarations)
        config.displays[-1].rename("A new name")
        gone, new = lines(before, config.to_yaml())
        assert len(gone) <= 1, path.name
        found = [line.strip(" -").replace('"', "") for line in new]
        assert found == ["Name: A new name"], path.name


def test_a_removed_display_of_a_real_file_takes_nothing_else_with_it(
    real_files: list[Path], declarations: Declarations
):
    for path in real_files[1::6]:
        config = RvizConfig.load(path, declarations)
        expected: Any = RvizConfig.load(path, declarations).raw
        del expected["Visualization Manager"]["Displays"][0]
        config.remove(config.displays[0])
        found: Any = reread(config, declarations).raw
        if not expected["Visualization Manager"]["Displays"]:
            expected["Visualization Manager"]["Displays"] = None
        assert found == expected, path.name


def test_random_edits_of_real_files_are_found_again(
    real_files: list[Path], declarations: Declarations
):
    rng = random.Random(2026)
    small = [path for path in real_files if path.stat().st_size < 15000]
    for path in rng.sample(small, 30):
        config = RvizConfig.load(path, declarations)
        for _ in range(6):
            _edit(rng, config)
        again = reread(config, declarations)
        assert _without_empty_lists(again.raw) == _without_empty_lists(config.raw)
        assert names(again.displays) == names(config.displays)
        pairs = zip(every(config.displays), every(again.displays), strict=True)
        for ours, found in pairs:
            assert ours.enabled == found.enabled
            for name, value in ours.properties.items():
                prop = ours.declared[name].property
                assert prop.agrees(value, found.get(name)), (path.name, name)


def _without_empty_lists(value: Plain) -> Plain:
    """RViz writes null for an empty list."""
    if isinstance(value, dict):
        return {key: _without_empty_lists(below) for key, below in value.items()}
    if isinstance(value, list):
        return [_without_empty_lists(below) for below in value] or None
    return value


def _edit(rng: random.Random, config: RvizConfig) -> None:
    everywhere = list(every(config.displays))
    if not everywhere:
        config.add_display("rviz_default_plugins/Grid")
        return
    display = rng.choice(everywhere)
    groups = [None, *(d for d in everywhere if d.kind == "rviz_common/Group")]
    kind = rng.choice(["set", "box", "rename", "add", "remove", "copy", "move"])
    if kind == "set" and "Alpha" in display.properties:
        display.set("Alpha", rng.random())
    elif kind == "box":
        display.set_enabled(not display.enabled)
    elif kind == "rename":
        display.rename(rng.choice(["x", "a: b", "# c", "", "true", "é한글", "1e5"]))
    elif kind == "add":
        config.add_display("rviz_default_plugins/Grid", group=rng.choice(groups))
    elif kind == "remove":
        config.remove(display)
    elif kind == "copy":
        config.duplicate(display)
    elif kind == "move":
        group = rng.choice(groups)
        if group is None or group not in every((display,)):
            config.move(display, rng.randrange(5), group)
