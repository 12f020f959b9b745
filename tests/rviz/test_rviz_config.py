from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from default_config import DEFAULT_TEXT

from sambot_viz.edits import apply_edits
from sambot_viz.errors import ConfigError
from sambot_viz.rviz import (
    BoolProperty,
    Declarations,
    EntryItem,
    FloatProperty,
    PropertyError,
    RvizConfig,
    UnknownPropertyError,
)

LINK = (
    BoolProperty("Value", default=True),
    FloatProperty("Alpha", default=1.0, minimum=0.0, maximum=1.0),
)
Parse = Callable[[str], RvizConfig]

GRID = "Class: rviz_default_plugins/Grid\nName: Grid\n"


def said(config: RvizConfig) -> list[str]:
    """The problems as lines of text."""
    return [str(problem) for problem in config.problems]


def test_the_first_config_is_read(shared: Path, declarations: Declarations):
    path = shared / "data/seed/urdf_config.rviz"
    config = RvizConfig.load(path, declarations)
    assert [d.name for d in config.displays] == ["Grid", "RobotModel", "TF"]
    assert all(display.enabled and display.supported for display in config.displays)
    _, robot, tf = config.displays
    assert robot.get("Alpha") == 0.6
    assert robot.get("Description Topic") == "/robot_description"
    assert tf.get("Show Names") is True
    assert tf.get("Marker Scale") == 0.3
    assert config.global_options.get("Fixed Frame") == "base_link"
    assert config.global_options.get("Background Color") == (48, 48, 48)
    assert config.view.kind == "rviz_default_plugins/Orbit"
    assert config.view.get("Distance") == 10.0
    assert config.problems == ()
    assert not config.modified


def test_a_display_s_texts_become_values(one_display: Parse):
    config = one_display(
        "Class: rviz_default_plugins/Grid\n"
        "Name: floor\n"
        "Enabled: true\n"
        'Plane Cell Count: "7"\n'
        "Cell Size: 3.2\n"
        "Offset: {X: -1, Y: 1.1, Z: 1.1e3}\n"
        "Color: white\n"
    )
    (grid,) = config.displays
    assert grid.name == "floor"
    assert grid.enabled
    assert grid.get("Plane Cell Count") == 7
    assert grid.get("Cell Size") == 3.2
    assert grid.get("Offset") == (-1.0, 1.1, 1100.0)
    assert grid.get("Color") == (255, 255, 255)
    assert grid.is_given("Color")
    assert not grid.is_given("Alpha")
    assert config.problems == ()


def test_both_spellings_of_a_property_with_children_are_read(one_display: Parse):
    flat = one_display(f"{GRID}Line Style: Billboards").displays[0]
    nested = one_display(
        f"{GRID}Line Style:\n  Line Width: 0.1\n  Value: Billboards"
    ).displays[0]
    assert flat.get("Line Style") == nested.get("Line Style") == "Billboards"
    assert flat.get("Line Style/Line Width") == 0.03
    assert nested.get("Line Style/Line Width") == 0.1


def test_groups_hold_displays_to_any_depth(parse: Parse):
    config = parse(
        """
Visualization Manager:
  Displays:
    - Class: rviz_common/Group
      Name: outer
      Enabled: true
      Displays:
        - Class: rviz_default_plugins/Grid
          Name: a
          Enabled: false
          Plane Cell Count: 17
        - Class: rviz_common/Group
          Name: inner
          Enabled: true
          Displays:
            - Class: rviz_default_plugins/Grid
              Name: b
              Enabled: true
              Plane Cell Count: 900
"""
    )
    (outer,) = config.displays
    a, inner = outer.displays
    (b,) = inner.displays
    assert [outer.supported, inner.kind] == [True, "rviz_common/Group"]
    assert (a.enabled, a.get("Plane Cell Count")) == (False, 17)
    assert (b.enabled, b.get("Plane Cell Count")) == (True, 900)
    assert b.parent is inner
    assert b.active
    outer.set_enabled(False)
    assert b.enabled
    assert not b.active


@pytest.mark.parametrize(
    ("keys", "enabled"),
    [
        ("Value: true", True),
        ("Enabled: true", True),
        ("", False),
        ("Enabled: false\nValue: true", False),
        ("Value: false\nEnabled: true", True),
        ("Enabled: ~\nValue: true", True),
    ],
)
def test_enabled_wins_over_value_and_neither_is_off(
    one_display: Parse, keys: str, enabled: bool
):
    assert one_display(GRID + keys).displays[0].enabled is enabled


def test_a_box_is_unticked_in_both_keys(one_display: Parse):
    config = one_display(f"{GRID}Enabled: true\nValue: true")
    before = config.to_yaml()
    config.displays[0].set_enabled(False)
    assert config.to_yaml() == before.replace("true", "false")


def test_a_box_that_was_not_in_the_file_is_added(one_display: Parse):
    config = one_display(GRID)
    config.displays[0].set_enabled(True)
    assert "      Enabled: true\n" in config.to_yaml()
    assert "Value" not in config.to_yaml()


def test_problems_name_file_line_and_column(one_display: Parse):
    config = one_display(
        f"{GRID}Alpha: 7\nPlane Cell Count: abc\nOffset: 1; 2; 3\nReference Frame: [a]"
    )
    grid = config.displays[0]
    assert grid.get("Alpha") == 1.0
    assert grid.get("Plane Cell Count") == 10
    assert grid.get("Offset") == (0.0, 0.0, 0.0)
    assert grid.get("Reference Frame") == "<Fixed Frame>"
    assert sorted((p.line, p.column) for p in config.problems) == [
        (6, 14),
        (7, 25),
        (8, 15),
        (9, 24),
    ]
    assert {p.code for p in config.problems} == {"config-value"}
    assert all(p.file == "my.rviz" and p.severity == "warning" for p in config.problems)


@pytest.mark.parametrize(
    ("display", "right", "wrong", "code"),
    [
        ("Grid", "Plane Cell Count: 20", "Plane Cel Count: 20", "config-property"),
        ("Grid", "Line Style: Lines", "Line Style: Line", "config-value"),
        (
            "Grid",
            "Line Style:{Value: Lines",
            "Line Stile:{Value: Lines",
            "config-property",
        ),
        (
            "RobotModel",
            "Description Topic:{Value: /r",
            "Topic:{Value: /r",
            "config-property",
        ),
        (
            "RobotModel",
            "Description Topic:{Reliability Policy: Best Effort",
            "Description Topic:{Reliability Policy: Best Efort",
            "config-value",
        ),
        (
            "Unknown",
            "Topic:{Durability Policy: Transient Local",
            "Topic:{Durability Policy: TransientLocal",
            "config-value",
        ),
    ],
)
def test_a_name_that_rviz_does_not_know_has_an_edit_that_mends_it(
    tmp_path: Path,
    declarations: Declarations,
    display: str,
    right: str,
    wrong: str,
    code: str,
) -> None:
    def written(text: str) -> str:
        below = text.replace("{", "\n        ")
        return (
            "Visualization Manager:\n  Displays:\n    - Class: "
            f"rviz_default_plugins/{display}\n      {below}\n"
        )

    (tmp_path / "c.rviz").write_text(written(wrong))
    config = RvizConfig.load(tmp_path / "c.rviz", declarations)
    (problem,) = config.problems
    assert problem.code == code
    assert apply_edits(problem.edits, written(wrong)) == written(right)


def test_a_key_that_stands_twice_is_told(one_display: Parse):
    config = one_display(f"{GRID}Alpha: 0.1\nAlpha: 0.2")
    assert config.displays[0].get("Alpha") == 0.2
    assert said(config) == [
        "my.rviz:7:14: warning[config-duplicate-key]: 'Alpha' is given twice in one "
        "map; the later one counts; remove the earlier one"
    ]


def test_a_null_means_nothing_given(one_display: Parse):
    grid = one_display(f"{GRID}Alpha: ~\nLine Style:\nOffset: null").displays[0]
    assert grid.get("Alpha") == 0.5
    assert grid.get("Line Style") == "Lines"
    assert grid.get("Offset") == (0.0, 0.0, 0.0)


def test_items_that_are_no_displays_are_kept_and_told(parse: Parse):
    config = parse("Visualization Manager:\n  Displays: [~, a, {Name: x}]\n")
    assert [(d.class_id, d.name, d.supported) for d in config.displays] == [
        ("(no class name found)", "x", False)
    ]
    assert [problem.message for problem in config.problems] == [
        "an item of 'Displays' is not a map with a class; it is kept"
    ] * 2


def test_an_unknown_class_is_listed_and_kept(one_display: Parse):
    config = one_display("Class: my_plugins/Radar\nName: r\nEnabled: true\nRange: 9")
    (radar,) = config.displays
    assert not radar.supported
    assert radar.enabled
    assert radar.raw == {
        "Class": "my_plugins/Radar",
        "Name": "r",
        "Enabled": "true",
        "Range": "9",
    }
    before = config.to_yaml()
    radar.rename("radar")
    assert config.to_yaml() == before.replace("Name: r\n", "Name: radar\n")


def test_unknown_keys_of_a_known_display_are_kept_and_listed(one_display: Parse):
    config = one_display(
        f"{GRID}Value: true\nGlow: 3\nLine Style: {{Value: Lines, Dash: 2}}\n"
        "Offset: {X: 0, Y: 0, Z: 0, Q: 1}"
    )
    grid = config.displays[0]
    assert grid.unknown_keys == ("Glow", "Line Style/Dash", "Offset/Q")
    grid.set("Alpha", 0.25)
    assert "Glow: 3\n" in config.to_yaml()
    assert "{Value: Lines, Dash: 2}" in config.to_yaml()


def test_a_set_value_is_clamped_returned_and_saved(one_display: Parse):
    config = one_display(f"{GRID}Alpha: 0.3  # pale")
    before, grid = config.to_yaml(), config.displays[0]
    assert grid.set("Alpha", 7) == 1.0
    assert grid.get("Alpha") == 1.0
    assert config.modified
    assert config.to_yaml() == before.replace("Alpha: 0.3 ", "Alpha: 1 ")
    assert grid.set("Alpha", 0.25) == 0.25
    grid.set("Alpha", 0.3)
    assert "Alpha: 0.30000001192092896  # pale" in config.to_yaml()


def test_the_same_value_again_changes_nothing(one_display: Parse):
    config = one_display(f"{GRID}Cell Size: 0.10000000149011612\nColor: white")
    grid = config.displays[0]
    grid.set("Cell Size", 0.1)
    grid.set("Color", (255, 255, 255))
    grid.set("Alpha", 0.5)
    grid.set_enabled(False)
    assert not config.modified


def test_a_broken_text_is_mended_by_setting_even_the_default(one_display: Parse):
    config = one_display(f"{GRID}Alpha: abc\nOffset: 1; 2; 3")
    grid = config.displays[0]
    grid.set("Alpha", 0.5)
    grid.set("Offset", (0, 0, 0))
    text = config.to_yaml()
    assert "      Alpha: 0.5\n" in text
    assert "      Offset:\n        X: 0\n        Y: 0\n        Z: 0\n" in text


def test_a_vector_s_unchanged_components_keep_their_text(one_display: Parse):
    config = one_display(f"{GRID}Offset:\n  X: 0.1\n  Y: 0.2 # left\n  Z: 0.3")
    before = config.to_yaml()
    config.displays[0].set("Offset", (0.1, 1.5, 0.3))
    assert config.to_yaml() == before.replace("Y: 0.2", "Y: 1.5")


def test_a_flat_property_becomes_a_map_when_a_child_is_set(one_display: Parse):
    config = one_display(f"{GRID}Line Style: Billboards")
    config.displays[0].set("Line Style/Line Width", 0.5)
    assert (
        "      Line Style:\n        Line Width: 0.5\n        Value: Billboards\n"
        in config.to_yaml()
    )


def test_a_new_property_with_children_is_written_as_rviz_does(one_display: Parse):
    config = one_display("Class: rviz_default_plugins/RobotModel\nName: R")
    robot = config.displays[0]
    robot.set("Mass Properties/Mass", True)
    robot.set("Description Topic", "/other")
    text = config.to_yaml()
    assert (
        "      Mass Properties:\n        Inertia: false\n        Mass: true\n" in text
    )
    assert (
        "      Description Topic:\n"
        "        Depth: 5\n"
        "        Durability Policy: Volatile\n"
        "        History Policy: Keep Last\n"
        "        Reliability Policy: Reliable\n"
        "        Value: /other\n"
    ) in text


def test_an_unknown_property_is_named_with_the_nearest_one(one_display: Parse):
    grid = one_display(GRID).displays[0]
    with pytest.raises(UnknownPropertyError) as caught:
        grid.get("Alhpa")
    assert str(caught.value) == (
        "'Grid' (rviz_default_plugins/Grid) has no 'Alhpa'; did you mean 'Alpha'?"
    )
    with pytest.raises(UnknownPropertyError):
        grid.set("Colour", "white")
    with pytest.raises(UnknownPropertyError):
        grid.is_shown("Colour")


def test_a_refused_value_changes_nothing(one_display: Parse):
    config = one_display(GRID)
    grid = config.displays[0]
    with pytest.raises(PropertyError):
        grid.set("Alpha", float("nan"))
    with pytest.raises(PropertyError):
        grid.rename("half \ud83d")
    assert grid.get("Alpha") == 0.5
    assert not config.modified


def test_a_row_is_hidden_until_its_condition_holds(one_display: Parse):
    grid = one_display(GRID).displays[0]
    assert not grid.is_shown("Line Style/Line Width")
    grid.set("Line Style", "Billboards")
    assert grid.is_shown("Line Style/Line Width")
    robot = one_display("Class: rviz_default_plugins/RobotModel").displays[0]
    assert robot.is_shown("Description Topic/Depth")
    robot.set("Description Source", "File")
    assert not robot.is_shown("Description Topic/Depth")
    assert robot.is_shown("Description File")


def test_links_can_be_read_and_written_whatever_their_names(one_display: Parse):
    config = one_display(
        "Class: rviz_default_plugins/RobotModel\n"
        "Name: R\n"
        "Link/Joint Tree:\n"
        "  base_link:\n"
        "    Details: {Alpha: 0.5}\n"
        "    Value: true\n"
        "  Link Tree Style: Tree of links and joints\n"
    )
    robot = config.displays[0]
    assert robot.dynamic("Link/Joint Tree") == {
        "base_link": {"Details": {"Alpha": "0.5"}, "Value": "true"},
        "Link Tree Style": "Tree of links and joints",
    }
    assert robot.dynamic(("Link/Joint Tree", "base_link", "Details")) == {
        "Alpha": "0.5"
    }
    assert robot.dynamic("Links") == {}
    base = EntryItem(robot, ("Link/Joint Tree", "base_link"), LINK, nested=True)
    assert base.get("Alpha") == 0.5
    base.set("Value", False)
    EntryItem(robot, ("Links", "wheel/left"), LINK).set("Alpha", 0.5)
    text = config.to_yaml()
    assert "    Details: {Alpha: 0.5}\n          Value: false\n" in text
    assert "      Links:\n        wheel/left:\n          Alpha: 0.5\n" in text


@pytest.mark.parametrize("written", ["{Value: false}", "false", "{Value: no}"])
def test_an_entry_is_read_from_a_map_or_from_a_text(one_display: Parse, written: str):
    config = one_display(
        f"Class: rviz_default_plugins/RobotModel\nLinks: {{arm: {written}}}"
    )
    before = config.to_yaml()
    arm = EntryItem(config.displays[0], ("Links", "arm"), LINK)
    assert dict(arm.properties) == {"Value": False, "Alpha": 1.0}
    assert config.to_yaml() == before
    arm.set("Alpha", 0.5)
    again = EntryItem(config.displays[0], ("Links", "arm"), LINK)
    assert dict(again.properties) == {"Value": False, "Alpha": 0.5}


@pytest.mark.parametrize(
    ("written", "alpha"), [("7", 1.0), ("-1", 0.0), (".5", 0.5), (".nan", 1.0)]
)
def test_a_bad_value_of_an_entry_is_clamped_and_reported_at_its_place(
    one_display: Parse, written: str, alpha: float
):
    config = one_display(
        f"Class: rviz_default_plugins/RobotModel\nLinks: {{arm: {{Alpha: {written}}}}}"
    )
    arm = EntryItem(config.displays[0], ("Links", "arm"), LINK)
    assert arm.get("Alpha") == alpha
    found = [problem.message for problem in config.problems]
    assert ["'Alpha' is" in message for message in found] == [True] * (alpha != 0.5)


def test_an_entry_that_another_one_has_made_meanwhile_is_kept(one_display: Parse):
    config = one_display("Class: rviz_default_plugins/RobotModel\nLink Tree: {}")
    robot = config.displays[0]
    base = EntryItem(robot, ("Link Tree", "base"), LINK, nested=True)
    arm = EntryItem(robot, ("Link Tree", "base", "arm"), LINK, nested=True)
    arm.set("Alpha", 0.5)
    base.set("Value", False)
    assert robot.dynamic("Link Tree") == {
        "base": {"Value": "false", "arm": {"Details": {"Alpha": "0.5"}}}
    }


def test_a_default_that_is_assumed_gives_way_to_what_the_file_says(one_display: Parse):
    config = one_display(
        "Class: rviz_default_plugins/RobotModel\nLinks: {arm: {Value: true}}"
    )
    arm, tool = (
        EntryItem(config.displays[0], ("Links", name), LINK) for name in ("arm", "tool")
    )
    for item in (arm, tool):
        item.assume("Value", False)
    assert (arm.get("Value"), tool.get("Value")) == (True, False)
    tool.set("Value", True)
    assert config.displays[0].dynamic(("Links", "tool")) == {"Value": "true"}


def test_names_of_links_and_frames_are_not_unknown_keys(one_display: Parse):
    tf = one_display(
        "Class: rviz_default_plugins/TF\n"
        "Frames: {All Enabled: false, base_link: {Value: true}}\n"
        "Tree: {map: {}}"
    ).displays[0]
    assert tf.unknown_keys == ()
    assert tf.get("Frames/All Enabled") is False
    assert tf.dynamic("Frames")["base_link"] == {"Value": "true"}


def test_global_options_are_added_to_a_file_without_them(parse: Parse):
    config = parse("Panels: []\n")
    assert config.global_options.get("Fixed Frame") == "base_link"
    config.global_options.set("Fixed Frame", "/odom")
    assert config.to_yaml() == (
        "Panels: []\nVisualization Manager:\n  Global Options:\n    Fixed Frame: odom\n"
    )


def test_an_empty_file_can_be_filled(parse: Parse):
    config = parse("")
    config.add_display("rviz_common/Group", "mine")
    assert config.to_yaml() == (
        "Visualization Manager:\n"
        "  Displays:\n"
        "    - Class: rviz_common/Group\n"
        "      Enabled: true\n"
        "      Name: mine\n"
    )


def test_a_file_of_ros_1_is_read_by_its_own_names_and_defaults(parse: Parse):
    config = parse(
        """
Visualization Manager:
  Displays:
    - Class: rviz/TF
      Name: TF
      Enabled: true
    - Class: rviz/RobotModel
      Name: R
      Robot Description: my_robot
    - Class: rviz/WrenchStamped
      Name: W
  Global Options:
    Default Light: false
    Fixed Frame: /map
"""
    )
    assert config.ros1
    tf, robot, wrench = config.displays
    assert (tf.class_id, tf.kind) == ("rviz/TF", "rviz_default_plugins/TF")
    assert tf.get("Show Names") is True
    assert robot.get("Robot Description") == "my_robot"
    assert wrench.kind == "rviz_default_plugins/Wrench"
    assert config.global_options.get("Fixed Frame") == "map"
    assert config.global_options.get("Default Light") is False
    added = config.add_display("rviz_default_plugins/Grid")
    assert (added.class_id, added.kind) == ("rviz/Grid", "rviz_default_plugins/Grid")
    assert "Class: rviz/Grid\n" in config.to_yaml()


def test_properties_of_ros_1_alone_do_not_appear_in_files_of_ros_2(one_display: Parse):
    config = one_display("Class: rviz_default_plugins/RobotModel\nName: R")
    assert "Robot Description" not in config.displays[0].properties
    assert "Default Light" not in config.global_options.properties


def test_the_default_config_has_one_grid_and_an_orbit_view(declarations: Declarations):
    config = RvizConfig.parse(DEFAULT_TEXT, declarations)
    assert [(d.kind, d.enabled) for d in config.displays] == [
        ("rviz_default_plugins/Grid", True)
    ]
    assert config.global_options.get("Fixed Frame") == "map"
    assert config.view.get("Distance") == 10.0
    assert len(config.tools) == 8
    assert config.file is None
    assert config.problems == ()
    assert not config.modified


def test_a_fixed_frame_that_is_a_list_does_not_stop_the_reading(parse: Parse):
    config = parse(
        "Visualization Manager:\n  Global Options:\n    Fixed Frame: [PLANNING_FRAME]\n"
    )
    assert config.global_options.get("Fixed Frame") == "base_link"
    assert len(config.problems) == 1


def test_a_config_is_saved_and_loaded_again(tmp_path: Path, declarations: Declarations):
    config = RvizConfig.parse(DEFAULT_TEXT, declarations)
    config.displays[0].set("Alpha", 0.75)
    path = tmp_path / "어떤 곳" / "my.rviz"
    with pytest.raises(ConfigError, match="config-unwritable"):
        config.save(path)
    path.parent.mkdir()
    assert config.modified
    config.save(path)
    assert not config.modified
    assert config.file == str(path)
    assert RvizConfig.load(path, declarations).displays[0].get("Alpha") == 0.75


def test_all_real_files_open_and_are_written_as_they_were(
    real_files: list[Path], declarations: Declarations
):
    for path in real_files:
        config = RvizConfig.load(path, declarations)
        assert config.displays or "visual_tests" in path.name
        assert {problem.severity for problem in config.problems} <= {"warning"}
        assert config.to_yaml().encode() == path.read_bytes(), path.name


def test_rviz_s_own_file_with_all_of_ros_1_opens(
    shared: Path, declarations: Declarations
):
    config = RvizConfig.load(
        shared / "data/rviz/ros2__rviz__all_ros1.rviz", declarations
    )
    assert config.ros1
    known = [d.class_id for d in config.displays if d.supported]
    assert known == ["rviz/Grid", "rviz/Group", "rviz/RobotModel", "rviz/TF"]
    kinds = [d.kind for d in config.displays]
    assert "rviz_default_plugins/Wrench" in kinds
    assert "rviz_plugin_tutorials/Imu" in kinds
    assert config.global_options.get("Fixed Frame") == "sentinel_frame"
    assert config.global_options.get("Default Light") is True
    assert "rviz/FrameAligned" in [view.class_id for view in config.saved_views]
