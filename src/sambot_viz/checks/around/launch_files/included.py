"""Find the launch file that another one includes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launch_files.declarations import declared_in
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call
from sambot_viz.checks.around.running.includes import installed_as
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.vocabulary import vocabulary

_FOXY, _AFTER_FOXY = "foxy:", "ros_gz_"
"""The mark of what was right in Foxy, and the beginning of packages that came later."""


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
        return IncludedFile(name, tuple(_of_age(known, around)))
    named = around.named(path)
    own = installed_as(*named) if named is not None else None
    if named is None or own is None:
        return None
    shown = named[0].shown(own)
    declared = declared_in(named[0]).get(shown)
    return None if declared is None else IncludedFile(name, tuple(declared))


def _of_age(words: tuple[str, ...], around: Surroundings) -> Iterator[str]:
    """Yield the words of a vocabulary for the distribution of the packages."""
    used = [name for package in around.packages for name in package.uses]
    used += [node.package for node in around.running.started]
    is_newer = any(name.startswith(_AFTER_FOXY) for name in used)
    for word in words:
        _, was_right, pair = word.partition(_FOXY)
        yield word if not was_right else pair if is_newer else pair.partition("=")[0]
