"""What a check does not pay for: modules of rules that have nothing to look at."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

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
        "sambot_viz.checks.rewritten",
        "sambot_viz.robot.slips.follow_ups",
        "sambot_viz.rviz.yaml.writer",
        f"{AROUND}files.python_repair",
        f"{AROUND}files.yaml_repair",
        f"{AROUND}in_setup",
        f"{AROUND}launching.frontend_reader",
        f"{AROUND}setup_file",
    }
    assert loaded & late == set()
