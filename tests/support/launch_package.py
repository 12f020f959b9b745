"""A package with a robot and two launch files, of which one starts more."""

from __future__ import annotations

from pathlib import Path

_MANIFEST = """
<package format="3"><name>robot</name><version>0.0.1</version>
<description>A robot.</description><maintainer email="a@b.c">A</maintainer>
<license>MIT</license><export><build_type>ament_cmake</build_type></export></package>
"""
_LAUNCH = """
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        {}
    ])
"""
_NODE = "Node(package='demo_nodes_cpp', executable='{0}', name='{0}'),"
LAUNCHES = {"small": ("listener",), "whole": ("listener", "talker")}


def launch_package(folder: Path) -> Path:
    """Write the package into a folder, and return its own folder."""
    package = folder / "robot"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text(_MANIFEST)
    (package / "robot.urdf").write_text('<robot name="r"><link name="base"/></robot>')
    for name, nodes in LAUNCHES.items():
        path = package / "launch" / f"{name}.launch.py"
        path.write_text(_LAUNCH.format("\n        ".join(map(_NODE.format, nodes))))
    return package
