"""``check`` of a small model costs little more than starting Python with numpy.

    python -m pytest tests/benchmarks/test_check.py -s

CPU time is compared, of processes that run in turn: graders start one for each file.
"""

from __future__ import annotations

import os
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from sambot_viz import bundled

CHECK = ["-m", "sambot_viz", "check"]
NUMPY = ["-c", "import numpy"]
MOST = 4.0
"""How many times as long as importing numpy (0.08 s alone on a machine of 2024)."""
MOST_OF_PACKAGE = 5.0
"""The same for a whole package."""


def cpu(arguments: list[str]) -> float:
    """CPU time of a Python process and of those it starts [s]."""
    before = os.times()
    subprocess.run([sys.executable, *arguments], stdout=subprocess.DEVNULL, check=True)
    after = os.times()
    return (
        after.children_user
        + after.children_system
        - before.children_user
        - before.children_system
    )


def test_sam_bot_is_checked_in_a_few_imports_of_numpy(
    compare: Callable[..., Any],
) -> None:
    model = str(bundled.model_path())
    result = compare(
        "check of sam_bot against import numpy",
        lambda: cpu([*CHECK, model]),
        lambda: cpu(NUMPY),
    )
    assert result.ratio <= MOST, str(result)


def test_an_stl_of_twelve_triangles_costs_no_more_than_a_box(
    compare: Callable[..., Any], tmp_path: Path
) -> None:
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    (tmp_path / "part.stl").write_bytes(bytes(80) + struct.pack("<I", 12) + 12 * facet)
    for name, shape in (
        ("mesh", '<mesh filename="part.stl"/>'),
        ("box", '<box size="1 1 1"/>'),
    ):
        visual = f"<visual><geometry>{shape}</geometry></visual>"
        text = f'<robot name="r"><link name="a">{visual}</link></robot>'
        (tmp_path / f"{name}.urdf").write_text(text)
    result = compare(
        "check of an STL against a box",
        lambda: cpu([*CHECK, str(tmp_path / "mesh.urdf")]),
        lambda: cpu([*CHECK, str(tmp_path / "box.urdf")]),
    )
    assert result.ratio <= 1.35, str(result)


def test_a_package_is_checked_in_a_few_imports_of_numpy(
    compare: Callable[..., Any], repository: Path
) -> None:
    """With its launch files, parameters, config and world; modules are compiled."""
    package = str(repository / "tests" / "data" / "around" / "gz")
    cpu([*CHECK, package])
    result = compare(
        "check of a package against import numpy",
        lambda: cpu([*CHECK, package]),
        lambda: cpu(NUMPY),
    )
    assert result.ratio <= MOST_OF_PACKAGE, str(result)


def test_plugins_cost_a_model_no_rules_about_packages(
    compare: Callable[..., Any], tmp_path: Path
) -> None:
    plugin = '<plugin filename="libgazebo_ros_imu_sensor.so" name="imu"/>'
    for name, more in (("plugin", f"<gazebo>{plugin}</gazebo>"), ("plain", "")):
        text = f'<robot name="r"><link name="a"/>{more}</robot>'
        (tmp_path / f"{name}.urdf").write_text(text)
    result = compare(
        "check of a model with a plugin against one without",
        lambda: cpu([*CHECK, str(tmp_path / "plugin.urdf")]),
        lambda: cpu([*CHECK, str(tmp_path / "plain.urdf")]),
    )
    assert result.ratio <= 1.5, str(result)
