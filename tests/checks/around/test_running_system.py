"""What launch files start, whatever their form, worked out without running them."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from manifests import written

from sambot_viz.checks.around.running import RunningNode, RunningSystem, running_system

MANIFEST = "<package><name>{}</name></package>"
IMPORTS = """\
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
"""

Packages = Callable[..., Path]


@pytest.fixture
def packages(tmp_path: Path) -> Packages:
    """Writes packages from paths and texts; returns the folder of the first."""

    def write(**files: dict[str, str]) -> Path:
        for name, texts in files.items():
            written(tmp_path / name, {"package.xml": MANIFEST.format(name), **texts})
        return tmp_path / next(iter(files))

    return write


def python(actions: str, before: str = "") -> str:
    return f"{IMPORTS}    {before}\n    return LaunchDescription([{actions}])\n"


def started(system: RunningSystem) -> dict[str, str]:
    return {node.path: node.starts for node in system.nodes}


def one(system: RunningSystem) -> RunningNode:
    (node,) = system.nodes
    return node


SAME = {
    "a.launch.py": python(
        """
        DeclareLaunchArgument("robot", default_value="cart"),
        DeclareLaunchArgument("teleop", default_value="false"),
        GroupAction([
            PushRosNamespace(LaunchConfiguration("robot")),
            Node(
                package="nav2_amcl",
                executable="amcl",
                namespace="inner",
                parameters=[
                    {"scan_topic": "laser", "filter": {"size": 3}},
                    PathJoinSubstitution([FindPackageShare("carts"), "amcl.yaml"]),
                ],
                remappings=[("map", ["/", LaunchConfiguration("robot"), "_map"])],
                arguments=["--ros-args", "-r", "tf:=/own_tf"],
            ),
        ]),
        Node(
            package="joy",
            executable="joy_node",
            condition=IfCondition(LaunchConfiguration("teleop")),
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            condition=UnlessCondition(LaunchConfiguration("teleop")),
        ),
        """
    ),
    "a.launch.xml": """
        <launch>
          <arg name="robot" default="cart"/>
          <arg name="teleop" default="false"/>
          <group>
            <push_ros_namespace namespace="$(var robot)"/>
            <node pkg="nav2_amcl" exec="amcl" namespace="inner"
                  args="--ros-args -r tf:=/own_tf">
              <param name="scan_topic" value="laser"/>
              <param name="filter"><param name="size" value="3"/></param>
              <param from="$(find-pkg-share carts)/amcl.yaml"/>
              <remap from="map" to="/$(var robot)_map"/>
            </node>
          </group>
          <node pkg="joy" exec="joy_node" if="$(var teleop)"/>
          <node pkg="rviz2" exec="rviz2" unless="$(var teleop)"/>
        </launch>
        """,
    "a.launch.yaml": """
launch:
- arg: {name: robot, default: cart}
- arg: {name: teleop, default: 'false'}
- group:
  - push_ros_namespace: {namespace: $(var robot)}
  - node:
      pkg: nav2_amcl
      exec: amcl
      namespace: inner
      args: --ros-args -r tf:=/own_tf
      param:
      - {name: scan_topic, value: laser}
      - {name: filter, param: [{name: size, value: 3}]}
      - {from: $(find-pkg-share carts)/amcl.yaml}
      remap:
      - {from: map, to: /$(var robot)_map}
- node: {pkg: joy, exec: joy_node, if: $(var teleop)}
- node: {pkg: rviz2, exec: rviz2, unless: $(var teleop)}
""",
}


@pytest.mark.parametrize("file", SAME)
def test_a_launch_file_starts_the_same_in_every_form(
    packages: Packages, file: str
) -> None:
    amcl = "/cart:\n  inner:\n    amcl:\n      ros__parameters: {base_frame_id: base}\n"
    folder = packages(carts={f"launch/{file}": SAME[file], "amcl.yaml": amcl})
    system = running_system(folder / "launch" / file)
    assert started(system) == {
        "/cart/inner/amcl": "yes",
        "/joy_node": "no",
        "/rviz2": "yes",
    }
    assert system.is_whole
    node = system.nodes[0]
    assert {each.name: each.value for each in node.parameters} == {
        "scan_topic": "laser",
        "filter.size": "3",
        "base_frame_id": "base",
    }
    assert node.parameters_known
    topics = {each.topic: each.publishes for each in node.endpoints}
    assert topics["/cart/inner/laser"] is False
    assert topics["/cart_map"] is False
    assert topics["/cart/inner/amcl_pose"] is True
    assert [(each.parent, each.child) for each in node.transforms] == [("map", "odom")]


@pytest.mark.parametrize(
    ("condition", "starts"),
    [
        ("IfCondition('true')", "yes"),
        ("IfCondition(LaunchConfiguration('never_declared'))", "unknown"),
        ("IfCondition(EnvironmentVariable('HOME'))", "unknown"),
        ("LaunchConfigurationEquals('mode', 'slam')", "yes"),
        ("LaunchConfigurationNotEquals('mode', 'slam')", "no"),
        ("IfCondition(PythonExpression([\"'\", mode, \"' == 'slam'\"]))", "yes"),
        ("IfCondition(PythonExpression([\"'\", mode, \"'.upper() in 'X'\"]))", "no"),
        ("IfCondition(PythonExpression(['len(', mode, ')']))", "unknown"),
        ("IfCondition(NotSubstitution(EqualsSubstitution(mode, 'slam')))", "no"),
        ("IfCondition(OrSubstitution(LaunchConfiguration('x'), 'true'))", "yes"),
        ("IfCondition(AndSubstitution(LaunchConfiguration('x'), 'true'))", "unknown"),
        ("my_condition()", "unknown"),
    ],
)
def test_a_condition_is_yes_no_or_unknown(
    packages: Packages, condition: str, starts: str
) -> None:
    text = python(
        "DeclareLaunchArgument('mode', default_value='slam'),"
        f"Node(package='joy', executable='joy_node', condition={condition})",
        before="mode = LaunchConfiguration('mode')",
    )
    folder = packages(carts={"launch/a.launch.py": text})
    assert one(running_system(folder)).starts == starts


@pytest.mark.parametrize(
    ("before", "starts"),
    [
        ("nodes = [Node(package='joy', executable='joy_node')]", "yes"),
        (
            "nodes = [Node(package='joy', executable=n + '_node') for n in ['joy']]",
            "yes",
        ),
        (
            "nodes = []\n    for name in ('joy',):\n"
            "        nodes.append(Node(package=name, executable=f'{name}_node'))",
            "yes",
        ),
        (
            "nodes = []\n    if input():\n"
            "        nodes += [Node(package='joy', executable='joy_node')]",
            "unknown",
        ),
        (
            "def made(n):\n        return Node(package=n, executable='joy_node')\n"
            "    nodes = [made('joy')]",
            "yes",
        ),
        (
            "nodes = [TimerAction(period=2.0, actions=[RegisterEventHandler("
            "OnProcessExit(target_action=None, on_exit=["
            "Node(package='joy', executable='joy_node')]))])]",
            "yes",
        ),
        (
            "def made(context):\n"
            "        return [Node(package='joy', executable='joy_node')]\n"
            "    nodes = [OpaqueFunction(function=made)]",
            "unknown",
        ),
    ],
)
def test_lists_loops_and_functions_of_python_are_followed(
    packages: Packages, before: str, starts: str
) -> None:
    folder = packages(carts={"launch/a.launch.py": python("*nodes", before)})
    node = one(running_system(folder))
    assert (node.package, node.executable, node.starts) == ("joy", "joy_node", starts)


INCLUDING = """
<launch>
  <include file="$(find-pkg-share parts)/launch/part.launch.xml">
    <arg name="name" value="front"/>
  </include>
</launch>
"""
PART = """
<launch>
  <arg name="name" default="rear"/>
  <node pkg="joy" exec="joy_node" name="$(var name)_joy"/>
</launch>
"""


def test_an_included_file_gets_its_arguments_and_says_who_includes_it(
    packages: Packages,
) -> None:
    folder = packages(
        carts={"launch/a.launch.xml": INCLUDING},
        parts={"launch/part.launch.xml": PART},
    )
    node = one(running_system(folder))
    assert node.path == "/front_joy"
    assert [Path(place.file).name for place in node.chain] == ["a.launch.xml"]
    assert Path(node.place.file).name == "part.launch.xml"


@pytest.mark.parametrize(
    "more",
    [
        "IncludeLaunchDescription(FindPackageShare('elsewhere'))",
        "OpaqueFunction(function=print)",
        "something()",
    ],
)
def test_what_may_start_more_is_named_with_its_place(
    packages: Packages, more: str
) -> None:
    folder = packages(carts={"launch/a.launch.py": python(more)})
    (unknown,) = running_system(folder).unknown
    assert Path(unknown.place.file).name == "a.launch.py"


@pytest.mark.parametrize(
    ("files", "known"),
    [(["config/ekf.yaml"], True), (["a/ekf.yaml", "ekf.yaml"], False)],
)
def test_a_relative_path_means_the_one_file_that_it_fits(
    packages: Packages, files: list[str], known: bool
) -> None:
    node_of = "Node(package='robot_localization', executable='ekf_node', name='ekf', "
    launch = python(f"{node_of}parameters=['ekf.yaml'])")
    text = "ekf: {ros__parameters: {odom0: wheels}}"
    given = dict.fromkeys(files, text)
    folder = packages(carts={"launch/a.launch.py": launch, **given})
    (node,) = (n for n in running_system(folder).nodes if n.place.file.endswith("py"))
    assert node.parameters_known == known
    assert [p.name for p in node.parameters if p.given_at] == ["odom0"] * known


def test_files_that_include_each_other_and_long_loops_end(packages: Packages) -> None:
    again = INCLUDING.replace("parts", "carts").replace("part.l", "a.l")
    deep = "x = ['a']\n" + "    x = x + x\n" * 40
    folder = packages(
        carts={"launch/a.launch.xml": again, "launch/b.launch.py": python("*x", deep)}
    )
    assert running_system(folder).nodes == ()


def test_each_launch_file_is_parsed_once(
    packages: Packages, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = packages(
        carts={
            "launch/a.launch.py": python(
                "*[IncludeLaunchDescription(FindPackageShare('carts')"
                "/ 'launch/b.launch.py')] * 3"
            ),
            "launch/b.launch.py": python("Node(package='joy', executable='joy_node')"),
        }
    )
    parsed = Counter[str]()
    parse = ast.parse

    def count(text: Any, *arguments: Any, **options: Any) -> ast.AST:
        parsed[str(text)] += 1
        return parse(text, *arguments, **options)

    monkeypatch.setattr(ast, "parse", count)
    running_system(folder)
    assert set(parsed.values()) == {1}
    assert len(parsed) == 2
