"""Find the launch file that another one includes."""

from __future__ import annotations

from dataclasses import dataclass

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launch_files.declarations import declared_in
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary


@dataclass(frozen=True, slots=True)
class IncludedFile:
    """A launch file that another one includes.

    Attributes:
        name: its file name.
        arguments: its declared arguments, as words of a vocabulary.
    """

    name: str
    arguments: tuple[str, ...]


def included_file(
    around: Surroundings, launch: LaunchFile, call: Call
) -> IncludedFile | None:
    """Return the known facts of an included file; None for an unknown one."""
    path = launch.text(call, "launch_description_source", 0) or ""
    package, _, below = path.removeprefix(SHARE).partition("/")
    name = below.rpartition("/")[2]
    known = vocabulary("launch_files").get(f"{package}/{name}")
    if known is not None:
        return IncludedFile(name, known)
    named = around.named(path)
    own = installed_as(*named) if named is not None else None
    if named is None or own is None:
        return None
    shown = named[0].shown(own)
    declared = declared_in(named[0]).get(shown)
    return None if declared is None else IncludedFile(name, tuple(declared))
