"""A package of a test: its files, and what colcon and rosdep ask of package.xml."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path


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


def written(folder: Path, files: Mapping[str, str]) -> Path:
    """Write the files of a package, by their paths in it, and return its folder."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder
