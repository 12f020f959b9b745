"""Words, paths and event handlers that launch takes otherwise than they look."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

MANIFEST = """<package format="3"><name>cart</name><version>0.0.1</version>
<description>A cart.</description><maintainer email="a@b.c">A</maintainer>
<license>MIT</license><exec_depend>controller_manager</exec_depend>
<exec_depend>ros_gz_sim</exec_depend><exec_depend>teleop_twist_joy</exec_depend>
<exec_depend>xacro</exec_depend><exec_depend>robot_state_publisher</exec_depend>
<exec_depend>ros2launch</exec_depend><exec_depend>launch_ros</exec_depend>
<export><build_type>ament_cmake</build_type></export></package>"""
PYTHON = """\
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    RegisterEventHandler,
    TimerAction,
)
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    model = LaunchConfiguration("model")
    world = LaunchConfiguration("world")
    text = Command(["xacro ", model, " sim:=", "true"])
    gazebo = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            [FindPackageShare("ros_gz_sim"), "/launch", "/gz_sim.launch.py"]
        ),
        launch_arguments={"gz_args": ["-r ", world]}.items(),
    )
    spawn = Node(
        package="ros_gz_sim",
        executable="create",
        arguments=['-topic', 'robot_description', "-z", '0.2'],
    )
    first = Node(
        package="controller_manager",
        executable="spawner",
        arguments=["a", "--controller-ros-args", "-r ~/cmd_vel:=/cmd_vel"],
    )
    second = Node(package="controller_manager", executable="spawner", arguments=["b"])
    teleop = Node(
        package="teleop_twist_joy",
        executable="teleop_node",
        remappings=[('cmd_vel', 'cmd_vel_joy')],
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("model"),
            DeclareLaunchArgument("world"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": text}],
            ),
            gazebo,
            spawn,
            ExecuteProcess(cmd=["sh", "-c", "echo a b"]),
            ExecuteProcess(cmd=["ros2", "control", "load_controller", "a"]),
            RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[first])),
            RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[second])),
            TimerAction(period=5.0, actions=[teleop]),
        ]
    )
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    (tmp_path / "launch").mkdir()
    (tmp_path / "package.xml").write_text(MANIFEST)
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(cart)\n"
        "find_package(ament_cmake REQUIRED)\n"
        "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\nament_package()\n"
    )
    (tmp_path / "launch" / "all.launch.py").write_text(PYTHON)
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    return tmp_path


def test_what_is_right_is_left_alone(package: Path) -> None:
    assert check(package) == []


@pytest.mark.parametrize(
    ("right", "wrong", "cause"),
    [
        ("'-topic', 'robot_description'", "'-topic robot_description'", "is one word"),
        ("'0.2'", "0.2", "arguments takes texts, and 0.2 is a number"),
        ("' sim:='", "'sim:='", "becomes a part of the word before it"),
        ("'-r '", "'-r'", "without a blank: -r and what follows"),
        ("'/launch', '/gz_sim", "'launch', 'gz_sim", "without a slash"),
        ('"control"', '"cotnrol"', "ros2 has no command cotnrol, but control"),
        ('"load_', '"laod_', "ros2 control has no command laod_controller"),
        ("'spawner'", "'spawner.py'", "both spawner.py and spawner"),
        ("'/launch', '/gz", "'/lanch', '/gz", "ros_gz_sim has no lanch/gz_sim"),
        ("('cmd_vel'", "('cmdvel'", "uses no name cmdvel, but cmd_vel"),
        ("n('model')\n", "n(model)\n", "model is used here, but gets its first"),
        ("5.0", "'5s'", "the period '5s' is not a number of seconds"),
        ("target_action=spawn", "target_action='spawn'", "not the text 'spawn'"),
        (
            "RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[first]))",
            "OnProcessExit(target_action=spawn, on_exit=[first])",
            "is an event handler and no action",
        ),
        ("target_action=first", "target_action=second", "only this handler starts"),
        (
            "[('cmd_vel', 'cmd_vel_joy')]",
            "('cmd_vel', 'cmd_vel_joy')",
            "remappings are a list of tuples",
        ),
        (
            "('cmd_vel', 'cmd_vel_joy')",
            "('cmd_vel_joy', 'cmd_vel')",
            "uses no name cmd_vel_joy, but cmd_vel",
        ),
    ],
)
def test_what_launch_takes_otherwise(
    package: Path, right: str, wrong: str, cause: str
) -> None:
    launch = package / "launch" / "all.launch.py"
    good = launch.read_text().replace('" sim:="', "' sim:='")
    good = good.replace('"-r "', "'-r '").replace('"/launch", "/gz', "'/launch', '/gz")
    good = good.replace('sim.launch.py"', "sim.launch.py'")
    good = good.replace('n("model")\n', "n('model')\n")
    good = good.replace('e="spawner",\n', "e='spawner',\n")
    launch.write_text(good.replace(right, wrong, 1))
    assert launch.read_text() != good

    (problem,) = check(package)

    assert cause in problem.message
    assert apply_edits(problem.edits, launch.read_text()) == good


def test_a_substitution_stays_one_word(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    right = """'-topic', 'robot_description'"""
    wrong = """'-c $(find my cart)/a.yaml'"""
    launch.write_text(PYTHON.replace(right, wrong))
    (problem,) = check(package)
    assert problem.hint == "write '-c', '$(find my cart)/a.yaml'"


RIGHT = '["ros2", "control", "load_controller", "a"]'


@pytest.mark.parametrize(
    ("wrong", "cause", "better"),
    [
        ("['ros2 control load_controller a']", "one word, the name of", None),
        ("[['ros2 control load_controller a']]", "one word, the name of", None),
        ("'ros2 control load_controller a'", "each of its letters is a word", None),
        ("'ls -l', shell=True", "each of its letters is", "['ls -l'], shell=True"),
        ("['echo $HOME']", "without a shell, so 'echo $HOME' is one word", ""),
        ("[['ros2 control ', 'load ', model]]", "so 'ros2 control load'", ""),
    ],
)
def test_a_command_has_its_words_in_a_list(
    package: Path, wrong: str, cause: str, better: str | None
) -> None:
    launch = package / "launch" / "all.launch.py"
    launch.write_text(PYTHON.replace(RIGHT, wrong))
    (problem,) = check(package)
    assert (problem.severity, cause in problem.message) == ("error", True)
    right = RIGHT.replace('"', "'") if better is None else better or wrong
    fixed = apply_edits(problem.edits, launch.read_text())
    assert fixed == PYTHON.replace(RIGHT, right)


@pytest.mark.parametrize(
    "right", ["['ls -l'], shell=True", "['/opt/My Robot/run']", "[model, 'a b']"]
)
def test_a_command_may_have_blanks(package: Path, right: str) -> None:
    launch = package / "launch" / "all.launch.py"
    launch.write_text(PYTHON.replace(RIGHT, right))
    assert check(package) == []


def test_a_handler_of_what_never_starts(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    launch.write_text(PYTHON.replace(f"{' ' * 12}spawn,\n", ""))
    (problem,) = check(package)
    assert "waits for the end of spawn, which nothing starts" in problem.message
    assert problem.hint == "add spawn to that list (line 42)"


def test_an_option_of_a_spawner_needs_its_value(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    launch.write_text(PYTHON.replace('["b"]', '["b", "--param-file"]'))
    (problem,) = check(package)
    assert "--param-file of the spawner has no value after it" in problem.message


def test_parts_of_a_path_in_a_misspelt_call_need_no_slash(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    right = '[FindPackageShare("ros_gz_sim"), "/launch", "/gz_sim.launch.py"]'
    path = '[PathJoinSubstituton([FindPackageShare("ros_gz_sim"), "launch", "a"])]'
    launch.write_text(PYTHON.replace(right, path))
    (problem,) = check(package)
    assert "neither imported nor defined" in problem.message


def test_a_node_in_xml_without_a_description(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    launch.unlink()
    launch = launch.with_suffix(".xml")
    launch.write_text(
        '<launch><node pkg="robot_state_publisher" exec="robot_state_publisher">\n'
        '<param name="description" value="$(command \'xacro r.urdf\')"/>\n'
        "</node></launch>"
    )
    (problem,) = check(package)
    assert (problem.line, problem.code) == (2, "launch-description")
    right = apply_edits(problem.edits, launch.read_text())
    assert '<param name="robot_description" value=' in right


def test_the_end_of_a_file_that_is_almost_another(package: Path) -> None:
    (package / "launch" / "a.yaml").write_text("a: 1\n")
    launch = package / "launch" / "all.launch.py"
    text = PYTHON.replace('"model"),', '"model", default_value=[world, "b.ymal"]),')
    launch.write_text(text)
    (problem,) = check(package)
    assert "no file here ends with .ymal" in problem.message
    assert apply_edits(problem.edits, text) == text.replace("ymal", "yaml")


def test_a_name_that_nothing_reads_is_the_wrong_one(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    launch.write_text(PYTHON.replace("    first =", "    firrst ="))
    (problem,) = check(package)
    assert apply_edits(problem.edits, launch.read_text()) == PYTHON


def test_a_text_that_is_called_as_a_module(package: Path) -> None:
    launch = package / "launch" / "all.launch.py"
    path = 'PathJoinSubstitution([FindPackageShare("cart"), "launch", "a", launch])'
    text = PYTHON.replace('LaunchConfiguration("world")', path)
    launch.write_text(text)
    problem = next(p for p in check(package) if "launch is used here" in p.message)
    better = text.replace("launch])", "'launch'])")
    assert apply_edits(problem.edits, text) == better


def test_a_command_in_xml_without_a_blank(package: Path) -> None:
    (package / "launch" / "all.launch.py").unlink()
    (package / "launch" / "all.launch.xml").write_text(
        '<launch><arg name="m"/><node pkg="robot_state_publisher" '
        'exec="robot_state_publisher">\n'
        '<param name="robot_description" value="$(command \'xacro$(var m)\')"/>\n'
        "</node></launch>"
    )
    (problem,) = check(package)
    assert (problem.line, problem.code) == (2, "launch-command")
