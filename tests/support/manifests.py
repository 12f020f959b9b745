"""The package.xml of a package of a test: what colcon and rosdep ask for, no more."""

from __future__ import annotations


def manifest(*dependencies: str) -> str:
    """Return the text for the package robot, with what it needs to run."""
    lines = [f"  <exec_depend>{name}</exec_depend>\n" for name in dependencies]
    return f"""\
<package format="3">
  <name>robot</name>
  <version>0.0.1</version>
  <description>A robot.</description>
  <maintainer email="me@example.org">me</maintainer>
  <license>MIT</license>
{"".join(lines)}</package>
"""
