"""What RViz does not know in a config, or cannot show, is found with its edit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from edited import edited_files
from manifests import manifest, written

from sambot_viz.checks import check
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.inputs import declarations
from sambot_viz.rviz import Property
from sambot_viz.rviz.properties.color import ColorProperty
from sambot_viz.rviz.properties.numbers import BoolProperty, FloatProperty, IntProperty
from sambot_viz.rviz.properties.texts import EnumProperty, PolicyProperty

CONFIG, NAME = "rviz/robot.rviz", "config-property"
FILES = {
    "package.xml": manifest(),
    "robot.urdf": '<robot name="r"><link name="base"/></robot>',
    CONFIG: """\
Visualization Manager:
  Global Options:
    Fixed Frame: base
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description File: ""
      Description Source: Topic
      Enabled: true
      Links:
        All Links Enabled: true
        Visual Enable: {Alpha: 1}
      Name: RobotModel
      TF Prefix: ""
    - Class: rviz_default_plugins/Map
      Enabled: true
      Topic:
        Depth: 5
        Value: /map
    - Class: rviz_imu_plugin/Imu
      Enabled: false
  Tools:
    - Class: rviz_default_plugins/SetGoal
      Topic:
        Value: /goal_pose
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Target Frame: <Fixed Frame>
""",
}
VALUES = """\
Visualization Manager:
  Global Options:
    Fixed Frame: base
    Frame Rate: 30
  Displays:
    - Class: rviz_default_plugins/Grid
      Alpha: 0.6
      Color: 160; 160; 164
      Enabled: true
      Line Style:
        Line Width: 0.03
        Value: Lines
      Offset:
        X: 0
        Y: 0
        Z: 0,5
      Plane: XY
      Plane Cell Count: 10
    - Class: rviz_default_plugins/RobotModel
      Collision Enabled: false
      Enabled: true
      Visual Enabled: true
    - Class: rviz_default_plugins/PointCloud2
      Color: red
      Enabled: true
      Topic:
        Depth: 5
        Reliability Policy: Reliable
        Value: /points
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 10
      Frame: <Fixed Frame>
      Pitch: 2.5
"""
"""Values that RViz takes."""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A right package with a config of RViz that no launch file names."""
    return written(tmp_path / "robot", FILES)


def test_a_view_follows_a_link_that_exists(package: Path) -> None:
    path = package / CONFIG
    path.write_text(path.read_text().replace("<Fixed Frame>", "bsae"))
    (problem,) = check(package)
    assert (problem.code, problem.hint) == ("frame-unknown", "write base")
    edited = edited_files(problem.edits)[str(path)].decode()
    assert "Target Frame: base\n" in edited


@pytest.mark.parametrize("first", ["Alpha: 1\n      ", ""])
def test_a_lost_dash_is_written_again(package: Path, first: str) -> None:
    path = package / CONFIG
    item = f"- {first}Class: rviz_default_plugins/Map"
    right = FILES[CONFIG].replace("- Class: rviz_default_plugins/Map", item)
    path.write_text(right.replace(item, f"  {item[2:]}"))
    (problem,) = [p for p in check(package) if p.code == "config-duplicate-key"]
    assert edited_files(problem.edits)[str(path)].decode() == right


@pytest.mark.parametrize(
    ("right", "wrong", "code"),
    [
        ("Value: /map", "Vlaue: /map", "config-property"),
        ("Depth: 5", "Dept: 5", "config-property"),
        ("Class: rviz_default_plugins/Map", "Cllass: rviz_default_plugins/Map", NAME),
        ("All Links Enabled", "All Links Enbaled", NAME),
        ("    Fixed Frame", "    Fxed Frame", NAME),
        ("      Enabled: true\n      Topic", "      Topic", NAME),
        ("Enabled: true\n      L", "Enabled: ture\n      L", "config-value"),
        ("rviz_imu_plugin/Imu\n      E", "rviz_imu_plugin/Imu\n      Ee", NAME),
        ("<Fixed Frame>", "<Fiexd Frame>", "frame-unknown"),
        ("plugins/SetGoal", "plugin/SetGoal", "config-class"),
        ("Source: Topic", "Source: File", "setup-description-topic"),
        ('Prefix: ""', "Prefix: cart", "frame-unknown"),
        ("Value: /goal_pose", "Value: /goalpose", "topic-unknown"),
    ],
)
def test_a_setting_that_has_no_effect_is_undone_by_its_edit(
    package: Path, right: str, wrong: str, code: str
) -> None:
    assert check(package) == []
    path = package / CONFIG
    path.write_text(path.read_text().replace(right, wrong))
    (problem,) = check(package)
    assert problem.code == code
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert check(package) == []


def declared() -> Iterator[Property]:
    """Yield what displays, tools and views declare, also below others."""
    known = declarations()
    waiting: list[Property] = [*known.global_options]
    for classes in (known.displays, known.tools, known.views):
        waiting += [each for kind in classes for each in classes[kind]]
    while waiting:
        one = waiting.pop()
        yield one
        waiting += one.children


def test_all_properties_that_are_declared_are_in_the_vocabulary() -> None:
    names = {one.name.replace(" ", "_") for one in declared()}
    assert names <= {*vocabulary("rviz_classes")["properties"]}


KINDS: Mapping[type[Property], str] = {
    BoolProperty: "bool",
    IntProperty: "int",
    FloatProperty: "float",
    ColorProperty: "color",
    EnumProperty: "one",
    PolicyProperty: "policy",
}


def test_the_vocabulary_of_values_takes_what_each_display_takes() -> None:
    table, met = vocabulary("rviz_values"), set[str]()
    for one in declared():
        name = one.name.replace(" ", "_")
        if type(one) not in KINDS:
            continue
        met.add(name)
        kind, *words = table[name]
        assert kind == KINDS[type(one)] or (kind, type(one)) == ("float", IntProperty)
        if kind in ("int", "float"):
            low, _, high = words[0].partition("..") if words else ("", "", "")
            assert not low or one.minimum >= float(low), name
            assert not high or one.maximum <= float(high), name
        else:
            assert {option.replace(" ", "_") for option in one.options} <= {*words}
    assert met == {*table}


@pytest.mark.parametrize(
    ("right", "wrong", "edited"),
    [
        ("Alpha: 0.6", "Alpha: 0,6", True),
        ("Color: 160; 160; 164", "Color: 160, 160, 164", True),
        ("Color: 160; 160; 164", "Color: grye", False),
        ("Line Width: 0.03", "Line Width: 3 cm", False),
        ("Value: Lines", "Value: Liness", True),
        ("Plane: XY", "Plane: XYZ", True),
        ("Cell Count: 10", "Cell Count: 10.0", True),
        ("Visual Enabled: true", "Visual Enabled: ture", True),
        ("Collision Enabled: false", "Collision Enabled: no", True),
        ("Y: 0", "Y: none", False),
        ("Reliability Policy: Reliable", "Reliability Policy: Relable", True),
        ("Frame Rate: 30", "Frame Rate: 30 Hz", False),
        ("Distance: 10", "Distance: 10 m", False),
    ],
)
def test_a_value_that_rviz_reads_otherwise_is_found(
    package: Path, right: str, wrong: str, edited: bool
) -> None:
    path = package / CONFIG
    path.write_text(VALUES)
    assert check(package) == []
    path.write_text(VALUES.replace(right, wrong))
    (problem,) = check(package)
    line = VALUES[: VALUES.index(right)].count("\n") + 1
    assert (problem.code, problem.line) in (
        ("config-value", line),
        # All parts of a vector are one value, which begins with X.
        ("config-value", line - 1),
    )
    if edited:
        path.write_bytes(edited_files(problem.edits)[str(path)])
        assert check(package) == []
    else:
        assert not problem.edits


def test_settings_of_a_second_config_count_too(package: Path) -> None:
    text = (package / CONFIG).read_text()
    second = package / "rviz/second.rviz"
    second.write_text(text.replace("Enabled: true\n      L", "Enabled: ture\n      L"))
    (problem,) = check(package)
    assert problem.code == "config-value"
    assert edited_files(problem.edits)[str(second)].decode() == text


def test_a_class_at_another_key_is_put_back(package: Path) -> None:
    path, text = package / CONFIG, (package / CONFIG).read_text()
    right = "Class: rviz_default_plugins/Map\n      Color: 1; 2; 3"
    text = text.replace("Class: rviz_default_plugins/Map", right)
    exchanged = "Class: 1; 2; 3\n      Color: rviz_default_plugins/Map"
    path.write_text(text.replace(right, exchanged))
    problem = next(p for p in check(package) if "no class 1; 2; 3" in p.message)
    assert edited_files(problem.edits)[str(path)].decode() == text


def test_the_fixed_frame_counts_in_each_config_that_is_opened(package: Path) -> None:
    text = (package / CONFIG).read_text().replace("Frame: base", "Frame: bsae")
    (package / "rviz/second.rviz").write_text(text)
    assert check(package) == []
    (package / "launch").mkdir()
    (package / "launch/view.launch.xml").write_text(
        '<launch><node pkg="rviz2" exec="rviz2" '
        'args="-d $(find-pkg-share robot)/rviz/second.rviz"/></launch>\n'
    )
    found = [p for p in check(package) if p.code == "setup-fixed-frame"]
    assert [p.file for p in found] == [str(package / "rviz/second.rviz")]
    assert [p.severity for p in found] == ["warning"]


def test_the_fixed_frame_of_a_config_with_this_robot_s_links_is_a_guess(
    package: Path,
) -> None:
    (package / "robot.urdf").write_text(TWO_LINKS)
    links = "Links:\n        base: {Alpha: 1}\n        arm: {Alpha: 1}"
    text = (package / CONFIG).read_text().replace("Links:", links)
    second = package / "rviz/second.rviz"
    second.write_text(text.replace("Frame: base", "Frame: chassis"))
    (problem,) = check(package)
    assert (problem.code, problem.severity) == ("setup-fixed-frame", "info")
    assert edited_files(problem.edits)[str(second)].decode() == text
    second.write_text(text.replace("Frame: base", "Frame: map"))
    (problem,) = check(package)
    assert not problem.edits


def test_a_display_hangs_on_a_frame_that_exists(package: Path) -> None:
    path = package / CONFIG
    grid = "    - Class: rviz_default_plugins/Grid\n      Enabled: true\n"
    grid += "      Reference Frame: <Fixed Frame>\n  Tools:"
    text = path.read_text().replace("  Tools:", grid)
    for right in ("<Fixed Frame>", "base", "odom"):
        path.write_text(text.replace(": <Fixed Frame>\n  Tools", f": {right}\n  Tools"))
        assert check(package) == []
    path.write_text(text.replace(": <Fixed Frame>\n  Tools", ": base_scan\n  Tools"))
    (problem,) = check(package)
    assert (problem.code, problem.severity) == ("frame-unknown", "warning")
    assert edited_files(problem.edits)[str(path)].decode() == text


TWO_LINKS = """\
<robot name="r">
  <link name="base"/>
  <link name="arm"/>
  <joint name="shoulder" type="fixed"><parent link="base"/><child link="arm"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("given", "prefix", "right"),
    [
        ("", "robot", '""'),
        ('<param name="frame_prefix" value="cart/"/>', "carrt", "cart"),
        ('<param name="frame_prefix" value="cart/"/>', "cart", None),
        ('<param name="frame_prefix" value="$(env PREFIX)"/>', "cart", None),
    ],
)
def test_the_prefix_of_the_frames_is_that_of_the_launch_file(
    package: Path, given: str, prefix: str, right: str | None
) -> None:
    launched(package, given)
    path = package / CONFIG
    path.write_text(path.read_text().replace('Prefix: ""', f"Prefix: {prefix}"))
    found = [p for p in check(package) if p.code == "frame-unknown"]
    assert len(found) == (right is not None)
    if right is not None:
        edited = edited_files(found[0].edits)[str(path)].decode()
        assert f"TF Prefix: {right}\n" in edited


@pytest.mark.parametrize(
    ("written", "namespace", "right"),
    [
        ("/robot/robot_description", "", "/robot_description"),
        ("/robot_description", "cart", "/cart/robot_description"),
        ("/cart/robot_description", "cart", None),
        ("/cart/robot_description", "$(env SPACE)", None),
    ],
)
def test_the_robot_is_read_from_the_namespace_that_has_it(
    package: Path, written: str, namespace: str, right: str | None
) -> None:
    launched(package, "", f'namespace="{namespace}"' if namespace else "")
    path = package / CONFIG
    topic = f"Description Topic:\n        Value: {written}\n      Enabled"
    path.write_text(path.read_text().replace("Enabled", topic, 1))
    found = [p for p in check(package) if p.code == "setup-description-topic"]
    assert len(found) == (right is not None)
    if right is not None:
        edited = edited_files(found[0].edits)[str(path)].decode()
        assert f"Value: {right}\n" in edited


@pytest.mark.parametrize(("remapped", "found"), [("cart", 0), ("truck", 1)])
def test_the_description_may_be_remapped(
    package: Path, remapped: str, found: int
) -> None:
    launched(package, f'<remap from="robot_description" to="{remapped}_description"/>')
    path = package / CONFIG
    topic = "Description Topic:\n        Value: /cart_description\n      Enabled"
    path.write_text(path.read_text().replace("Enabled", topic, 1))
    codes = [p.code for p in check(package)]
    assert codes.count("setup-description-topic") == found


def launched(package: Path, parameter: str, attributes: str = "") -> None:
    """Write a launch file that starts the robot and RViz."""
    (package / "launch").mkdir()
    (package / "launch/view.launch.xml").write_text(
        f"""<launch>
  <node pkg="robot_state_publisher" exec="robot_state_publisher" {attributes}>
    <param name="robot_description" value="$(command 'cat robot.urdf')"/>{parameter}
  </node>
  <node pkg="rviz2" exec="rviz2" args="-d $(find-pkg-share robot)/{CONFIG}"/>
</launch>
"""
    )


def test_a_map_that_is_volatile_is_a_guess(package: Path) -> None:
    path, text = package / CONFIG, (package / CONFIG).read_text()
    policy = "Depth: 5\n        Durability Policy: "
    path.write_text(text.replace("Depth: 5", f"{policy}Volatile"))
    (problem,) = check(package)
    assert (problem.code, problem.severity) == ("display-volatile", "info")
    right = text.replace("Depth: 5", f"{policy}Transient Local")
    assert edited_files(problem.edits)[str(path)].decode() == right
