"""Sample declarations, so that these tests need no display."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.rviz import (
    BoolProperty,
    ColorProperty,
    Declarations,
    EnumProperty,
    FileProperty,
    FloatProperty,
    GroupProperty,
    IntProperty,
    Property,
    RvizConfig,
    StringProperty,
    TfFrameProperty,
    TopicProperty,
    VectorProperty,
)

GRID: tuple[Property, ...] = (
    TfFrameProperty("Reference Frame"),
    IntProperty("Plane Cell Count", default=10, minimum=1),
    IntProperty("Normal Cell Count", default=0, minimum=0),
    FloatProperty("Cell Size", default=1.0, minimum=0.0001, unit="m"),
    EnumProperty(
        "Line Style",
        default="Lines",
        options=("Lines", "Billboards"),
        children=(
            FloatProperty(
                "Line Width",
                default=0.03,
                minimum=0.001,
                hidden_unless=("Line Style", "Billboards"),
            ),
        ),
    ),
    ColorProperty("Color", default=(160, 160, 164)),
    FloatProperty("Alpha", default=0.5, minimum=0.0, maximum=1.0),
    EnumProperty("Plane", default="XY", options=("XY", "XZ", "YZ")),
    VectorProperty("Offset", unit="m"),
)
ROBOT_MODEL: tuple[Property, ...] = (
    BoolProperty("Visual Enabled", default=True),
    BoolProperty("Collision Enabled", default=False),
    GroupProperty(
        "Mass Properties",
        children=(BoolProperty("Mass"), BoolProperty("Inertia", support="none")),
    ),
    FloatProperty("Update Interval", minimum=0.0, support="approximate", note="live"),
    FloatProperty("Alpha", default=1.0, minimum=0.0, maximum=1.0),
    EnumProperty("Description Source", default="Topic", options=("Topic", "File")),
    FileProperty("Description File", hidden_unless=("Description Source", "File")),
    TopicProperty("Description Topic", hidden_unless=("Description Source", "Topic")),
    StringProperty("Robot Description", default="robot_description", ros1_only=True),
    StringProperty("TF Prefix"),
    GroupProperty("Links", open_keys=True),
)
TF: tuple[Property, ...] = (
    BoolProperty("Show Names", default=False, ros1_default=True),
    FloatProperty("Marker Scale", default=1.0),
    GroupProperty(
        "Frames", children=(BoolProperty("All Enabled", default=True),), open_keys=True
    ),
    GroupProperty("Tree", open_keys=True),
)
ORBIT: tuple[Property, ...] = (
    FloatProperty("Near Clip Distance", default=0.01, minimum=0.001, maximum=10000.0),
    TfFrameProperty("Target Frame"),
    FloatProperty("Distance", default=10.0, minimum=0.001),
    FloatProperty("Yaw", default=0.785398),
    FloatProperty("Pitch", default=0.785398, minimum=-1.5697963, maximum=1.5697963),
    VectorProperty("Focal Point"),
)
TOP_DOWN: tuple[Property, ...] = (
    FloatProperty("Near Clip Distance", default=0.01, minimum=0.001, maximum=10000.0),
    TfFrameProperty("Target Frame"),
    FloatProperty("Scale", default=10.0),
)


@pytest.fixture(scope="session")
def declarations() -> Declarations:
    """A Grid, a RobotModel, a TF; an Orbit and a TopDownOrtho view; one tool."""
    package = "rviz_default_plugins"
    return Declarations(
        displays={
            f"{package}/Grid": GRID,
            f"{package}/RobotModel": ROBOT_MODEL,
            f"{package}/TF": TF,
        },
        views={f"{package}/Orbit": ORBIT, f"{package}/TopDownOrtho": TOP_DOWN},
        tools={f"{package}/Measure": (ColorProperty("Line color"),)},
    )


@pytest.fixture
def parse(declarations: Declarations) -> Callable[[str], RvizConfig]:
    """Read a text as the file "my.rviz"."""
    return lambda text: RvizConfig.parse(text, declarations, file="my.rviz")


@pytest.fixture
def one_display(
    parse: Callable[[str], RvizConfig],
) -> Callable[[str], RvizConfig]:
    """Read a config with one display: its keys, one a line."""

    def make(keys: str) -> RvizConfig:
        lines = "\n".join(f"      {line}" for line in keys.strip("\n").splitlines())
        head = "Visualization Manager:\n  Displays:\n    -\n"
        return parse(f"{head}{lines}\n")

    return make


@pytest.fixture(scope="session")
def real_files(shared: Path) -> list[Path]:
    """Configs of public repositories, of our recordings, and the first one."""
    folders = (
        shared / "data/rviz",
        shared / "data/seed",
        shared / "data/golden/images",
    )
    found = [path for folder in folders for path in sorted(folder.rglob("*.rviz"))]
    return found + sorted((shared / "data/rviz").glob("*.rviz.default"))
