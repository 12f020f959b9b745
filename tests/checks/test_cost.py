"""What a check does not pay for: modules that it does not need, files read again."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from sambot_viz import bundled

AROUND = "sambot_viz.checks.around."


def loaded_by_check(path: Path) -> set[str]:
    """The modules that a process of its own has loaded after checking a path."""
    script = (
        "import sys\nfrom sambot_viz import check\ncheck(sys.argv[1])\n"
        "print(*sys.modules)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", script, str(path)],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(ran.stdout.split())


def test_a_model_with_plugins_in_no_package_needs_no_rules_about_packages(
    tmp_path: Path,
) -> None:
    model = tmp_path / "robot.urdf"
    plugin = '<plugin filename="libgazebo_ros_imu_sensor.so" name="imu"/>'
    model.write_text(
        f'<robot name="r"><link name="a"/><gazebo>{plugin}</gazebo></robot>'
    )
    loaded = loaded_by_check(model)
    assert f"{AROUND}in_model" in loaded
    late = ("rules", "surroundings", "launch_file", "workspace", "files.parameters")
    assert not loaded & {f"{AROUND}{name}" for name in late}


def test_a_model_without_plugins_needs_no_rules_about_names() -> None:
    loaded = loaded_by_check(bundled.model_path())
    assert f"{AROUND}in_model" not in loaded


def test_a_right_package_needs_no_module_about_what_is_wrong(repository: Path) -> None:
    loaded = loaded_by_check(repository / "tests" / "data" / "around" / "gz")
    assert f"{AROUND}rules" in loaded
    late = {
        "re2",
        "sambot_viz.checks.model.rewritten",
        "sambot_viz.robot.slips.follow_ups",
        "sambot_viz.rviz.yaml.writer",
        f"{AROUND}files.python_repair",
        f"{AROUND}files.yaml_repair",
        f"{AROUND}in_setup",
        f"{AROUND}launching.frontend_reader",
        f"{AROUND}setup_file",
    }
    assert loaded & late == set()


AUDIT = """
import json, sys
from collections import Counter

root, opened, parsed = sys.argv[1], Counter(), Counter()

def note(event, arguments):
    if event == "open" and str(arguments[0]).startswith(root):
        opened[str(arguments[0])] += 1
    if event == "compile" and b"generate_launch_description()" in bytes(
        str(arguments[0]), "utf-8"
    ):
        parsed[str(arguments[0])] += 1

from sambot_viz.cli import main

sys.addaudithook(note)
status = main(["check", root])
print()
print(json.dumps([status, opened, [*parsed.values()]]))
"""


@pytest.mark.parametrize("name", ["gz", "classic"])
def test_a_check_opens_each_file_once_and_parses_python_once(
    name: str, repository: Path, tmp_path: Path
) -> None:
    """Also for the lines around a finding, which the model has here."""
    package = tmp_path / "sam_bot_description"
    shutil.copytree(repository / "tests" / "data" / "around" / name, package)
    launch = next((package / "launch").glob("*.launch.py"))
    launch.write_text(
        launch.read_text("utf-8").replace('executable="rviz2"', 'executable="rviz"'),
        "utf-8",
    )
    ran = subprocess.run(
        [sys.executable, "-c", AUDIT, str(package)],
        capture_output=True,
        text=True,
        check=True,
    )
    _, opened, parsed = json.loads(ran.stdout.splitlines()[-1])
    assert len(opened) > 5
    assert {path for path, times in opened.items() if times > 1} == set()
    assert parsed and set(parsed) == {1}
