"""Words that a program does not read are found, and the edits give the right file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from edited import edited_files

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
LAUNCH = "launch/display.launch.py"
SETUP = "setup.py"
BRIDGE = "config/bridge_config.yaml"
WORLD = "world/room.sdf"
SETUP_TEXT = """\
from glob import glob
from setuptools import setup

setup(
    name='cart_description',
    packages=['cart_description'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/cart_description']),
        ('share/cart_description', ['package.xml']),
        ('share/cart_description/launch', glob('launch/*.launch.py')),
        ('share/cart_description/urdf', glob('urdf/*')),
        ('share/cart_description/config', glob('config/*.yaml')),
        ('share/cart_description/rviz', glob('rviz/*.rviz')),
        ('share/cart_description/world', glob('world/*.sdf')),
    ],
    entry_points={'console_scripts': ['drive = cart_description.drive:main']},
)
"""


@pytest.fixture
def package(copied: Callable[[str], Path]) -> Path:
    """A right package of Python."""
    folder = copied("gz")
    (folder / "CMakeLists.txt").unlink()
    manifest = folder / "package.xml"
    kind = "_python</build_type>"
    manifest.write_text(manifest.read_text().replace("_cmake</build_type>", kind))
    launch = folder / LAUNCH
    given = 'parameters=[{"robot_description": description}],'
    old = 'parameters=[\n            {"robot_description": description},'
    head, _, rest = launch.read_text().partition(old)
    launch.write_text(f"{head}{given}{rest.partition('],')[2]}")
    files = {
        SETUP: SETUP_TEXT,
        "setup.cfg": "[develop]\nscript_dir=$base/lib/cart_description\n"
        "[install]\ninstall_scripts=$base/lib/cart_description\n",
        "resource/cart_description": "",
        "cart_description/__init__.py": "",
        "cart_description/drive.py": "def main():\n    pass\n",
    }
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize(
    ("file", "right", "wrong", "code", "cause"),
    [
        (
            LAUNCH,
            'executable="robot_state_publisher"',
            'node_executable="robot_state_publisher"',
            "launch-code",
            "Node has no argument node_executable, but executable",
        ),
        (
            LAUNCH,
            "GzServer(world_sdf_file=world)",
            "GzServer(world=world)",
            "launch-code",
            "GzServer has no argument world, but world_sdf_file",
        ),
        (
            LAUNCH,
            'default_value="True"',
            "default_value=True",
            "launch-code",
            "default_value is True, and launch takes only texts",
        ),
        (
            LAUNCH,
            '"entity_name": "cart"',
            '"entity_name": "cart", "z": 0.5',
            "launch-code",
            "z is 0.5, and launch takes only texts",
        ),
        (
            LAUNCH,
            "}.items(),",
            "},",
            "launch-code",
            "a dict gives its names alone",
        ),
        (
            LAUNCH,
            'package="robot_localization"',
            'package="robot_localisation"',
            "launch-package-unknown",
            "ekf_node is in robot_localization",
        ),
        (
            LAUNCH,
            'executable="ekf_node"',
            'executable="ekf_localization_node"',
            "launch-program-unknown",
            "has no program ekf_localization_node",
        ),
        (
            LAUNCH,
            '"config/ekf.yaml"',
            '"/config/ekf.yaml"',
            "launch-file-missing",
            "os.path.join drops what is before /config/ekf.yaml",
        ),
        (
            LAUNCH,
            'executable="ekf_node",',
            'executable="ekf_node"  # the filter',
            "python-syntax",
            "a comma is missing at the end of this line",
        ),
        (
            LAUNCH,
            'parameters=[{"robot_description": description}],',
            'parameters=["robot_description": description],',
            "python-syntax",
            "a : is in square brackets",
        ),
        (LAUNCH, "import os\n", "", "launch-code", "os is used here"),
        (
            "config/ekf.yaml",
            "frequency: 30.0",
            "frequency 30.0",
            "parameters-yaml",
            "no colon after frequency",
        ),
        (
            "package.xml",
            "BSD-3-Clause</license>",
            "BSD-3-Clause<license>",
            "package-xml",
            "<license> is opened twice",
        ),
        (
            MODEL,
            "<gz_frame_id>imu_link</gz_frame_id>",
            "<frame_id>imu_link</frame_id>",
            "gazebo-element-unknown",
            "Gazebo does not read <frame_id> of the sensor imu",
        ),
        (
            MODEL,
            "<topic>/demo/cmd_vel</topic>",
            "<cmd_vel_topic>/demo/cmd_vel</cmd_vel_topic>",
            "gazebo-element-unknown",
            "does not read <cmd_vel_topic>",
        ),
        (
            MODEL,
            'type="imu"',
            'type="imu_sensor"',
            "gazebo-sensor",
            'no sensors of type "imu_sensor"',
        ),
        (
            BRIDGE,
            'ros_topic_name: "/demo/imu"',
            'topic_name: "/demo/imu"',
            "bridge-entry",
            "gz_topic_name is given too: the bridge leaves this topic out",
        ),
        (
            WORLD,
            "systems::Sensors",
            "systems::Sensor",
            "gazebo-plugin",
            "no class gz::sim::systems::Sensor",
        ),
        (
            WORLD,
            "gz-sim-sensors-system",
            "gz-sim-sensors-sytem",
            "gazebo-plugin",
            "Gazebo has no plugin gz-sim-sensors-sytem",
        ),
        (
            SETUP,
            "['package.xml']",
            "'package.xml'",
            "setup-py-code",
            "each letter is taken for a file",
        ),
        (
            SETUP,
            "glob('config/*.yaml')",
            "'config/*.yaml'",
            "setup-py-code",
            "the text config/*.yaml and no list",
        ),
        (
            SETUP,
            "drive:main",
            "drive.main",
            "entry-point-missing",
            "a colon has to be before the function main",
        ),
        (
            SETUP,
            "'console_scripts'",
            "'console_script'",
            "setup-py-code",
            "entry_points has no console_script, but console_scripts",
        ),
        (SETUP, "    packages", "    pakages", "setup-py-code", "has no pakages"),
    ],
)
def test_a_word_that_nothing_reads_is_written_rightly_by_its_edit(
    package: Path, file: str, right: str, wrong: str, code: str, cause: str
) -> None:
    path = package / file
    text = path.read_text()
    assert right in text
    path.write_text(text.replace(right, wrong))
    (problem,) = check(package / MODEL)
    assert problem.code == code
    assert cause in problem.message
    path.write_bytes(edited_files(problem.edits)[str(path)])
    assert check(package / MODEL) == []
