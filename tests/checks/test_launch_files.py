"""Launch files and setup.py of a package without a model, or with one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.errors import Problem

MODEL = """\
<robot name="r">
  <link name="base_link"/><link name="wheel_link"/>
  <joint name="wheel_joint" type="continuous">
    <parent link="base_link"/><child link="wheel_link"/>
  </joint>
</robot>
"""
Checked = Callable[..., list[Problem]]


@pytest.fixture
def checked(tmp_path: Path) -> Checked:
    """Checks a package with a launch file, and with a robot where one is given."""

    def run(launch: str, name: str, model: str = "") -> list[Problem]:
        package = tmp_path / name
        (package / "launch").mkdir(parents=True)
        manifest = f"<package><name>{name}</name></package>"
        (package / "package.xml").write_text(manifest)
        (package / "launch" / "x.launch.py").write_text(launch)
        if model:
            (package / "r.urdf").write_text(model)
        found = check(package)
        return [p for p in found if p.code != "package-without-model"]

    return run


def _of_collection(shared: Path, name: str) -> str:
    return (shared / "data" / "bad-models" / "launch" / name).read_text("utf-8")


def test_a_launch_file_in_which_no_node_publishes_joints_is_explained(
    shared: Path, checked: Checked
) -> None:
    text = _of_collection(shared, "gui-true-but-no-gui-node.launch.py")

    (problem,) = checked(text, "mini_bot", MODEL)

    assert problem.severity == "warning"
    assert problem.line == 20
    assert "wheel_joint stays without a transform" in problem.message


def test_a_launch_file_with_the_gui_node_is_fine(
    shared: Path, checked: Checked
) -> None:
    bad = _of_collection(shared, "gui-true-but-no-gui-node.launch.py")
    added = (
        "Node(package='joint_state_publisher_gui', "
        "executable='joint_state_publisher_gui'),\n        Node(package='rviz2'"
    )
    assert checked(bad.replace("Node(package='rviz2'", added), "mini_bot") == []


def test_a_launch_file_that_asks_for_a_nearly_right_package_is_explained(
    shared: Path, checked: Checked
) -> None:
    text = _of_collection(shared, "package-not-found.launch.py")

    (problem,) = checked(text, "mbot_pkg")

    assert problem.severity == "error"
    assert problem.line == 8
    assert problem.hint == "write mbot_pkg"
    assert checked(text, "turtlebot3_gazebo") == []


def test_setup_py_and_package_xml_have_to_agree(shared: Path) -> None:
    folder = shared / "data" / "bad-models" / "launch" / "setup-py-name-mismatch"

    # The file of resource that is missing is there with the right name.
    problem, note = check(folder)

    assert problem.severity == "error"
    assert problem.line == 3
    assert "mbot_code" in problem.message
    assert note.code == "package-without-model"


def test_of_two_names_of_the_package_one_is_wrong(checked: Checked) -> None:
    launch = (
        "from launch import LaunchDescription\n"
        "from launch_ros.substitutions import FindPackageShare\n\n"
        "def generate_launch_description():\n"
        '    FindPackageShare("cartt_description")\n'
        "    return LaunchDescription([])\n"
    )
    (problem,) = checked(launch, "cart_description")
    assert problem.code == "launch-package-unknown"
    package = Path(problem.file or "").parents[1]
    # The finding at package.xml has the other fix.
    text = "project(cartt_description)\nfind_package(ament_cmake)\nament_package()\n"
    (package / "CMakeLists.txt").write_text(text)
    codes = [p.code for p in check(package)]
    assert "launch-package-unknown" not in codes
    assert "cmake-project-name" in codes


@pytest.mark.parametrize(
    ("asked", "beside"),
    [
        ("cart_descriptions", "cart_descriptions"),
        ("cart_description_moveit_config", ""),
        ("cart_controller", ""),
        ("cart_bringup2", ""),
    ],
)
def test_another_package_of_the_robot_is_no_misspelt_one(
    asked: str, beside: str, checked: Checked, tmp_path: Path
) -> None:
    if beside:
        manifest = tmp_path / beside / "package.xml"
        manifest.parent.mkdir()
        manifest.write_text(f"<package><name>{beside}</name></package>")
    launch = (
        "from launch import LaunchDescription\n"
        "from launch_ros.substitutions import FindPackageShare\n\n"
        "def generate_launch_description():\n"
        f'    FindPackageShare("{asked}")\n'
        "    return LaunchDescription([])\n"
    )
    assert checked(launch, "cart_description") == []


@pytest.mark.parametrize(("file", "found"), [("launch", 1), ("maps", 0)])
def test_a_package_whose_files_are_not_here_is_another_one(
    file: str, found: int, checked: Checked
) -> None:
    launch = (
        "import os\n"
        "from ament_index_python.packages import get_package_share_directory\n"
        "from launch import LaunchDescription\n"
        "from launch.actions import IncludeLaunchDescription\n\n"
        "def generate_launch_description():\n"
        f'    path = os.path.join(get_package_share_directory("cart_maps"), "{file}")\n'
        "    return LaunchDescription([IncludeLaunchDescription(path)])\n"
    )
    codes = [problem.code for problem in checked(launch, "cart_pkg")]
    assert codes.count("launch-package-unknown") == found


@pytest.mark.parametrize(
    ("package", "found"), [("ros_ign_bridge", 0), ("ros_gz_bridg", 1)]
)
def test_a_package_of_another_version_of_ros_is_known(
    package: str, found: int, checked: Checked
) -> None:
    launch = (
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n\n"
        "def generate_launch_description():\n"
        f'    node = Node(package="{package}", executable="parameter_bridge")\n'
        "    return LaunchDescription([node])\n"
    )
    codes = [problem.code for problem in checked(launch, "cart_pkg")]
    assert codes.count("launch-package-unknown") == found
