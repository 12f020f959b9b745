"""Tell a model from the other files of a package, which are checked with it."""

from __future__ import annotations

from pathlib import Path

from sambot_viz import limits
from sambot_viz.files import read_limited, relative_path
from sambot_viz.robot.packages.package_index import package_around
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import parse_xml

_NAMES = ("package.xml", "CMakeLists.txt", "setup.py", "setup.cfg")
_ENDINGS = (".launch", ".py", ".rviz", ".world", ".yaml", ".yml")


def package_of_other(path: Path) -> Path | None:
    """Return the package of a file that is no model; None for a model, or without one.

    Args:
        path: a file, or a folder.

    Returns:
        The folder; as seen from here, if the path is.
    """
    if not path.is_file() or not (_is_named_so(path) or _is_other_xml(path)):
        return None
    package = package_around(path)
    if package is None or path.is_absolute():
        return package
    return Path(relative_path(package))


def _is_named_so(path: Path) -> bool:
    return path.name in _NAMES or path.suffix.lower() in _ENDINGS


def _is_other_xml(path: Path) -> bool:
    """Return whether a file is a launch file or a world without an error."""
    if path.suffix.lower() not in (".xml", ".sdf"):
        return False
    try:
        data = read_limited(path, limits.MODEL.value)
        root = parse_xml(data.decode("utf-8"), path.name)
    except (OSError, ValueError, XmlFault):
        return False
    inside = [child.tag for child in root.children]
    return root.tag == "launch" or (root.tag == "sdf" and inside == ["world"])
