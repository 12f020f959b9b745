"""Find what launch files start, without running them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from sambot_viz.checks.around.running.assemble import system_of
from sambot_viz.checks.around.running.system import (
    Endpoint,
    GivenParameter,
    PublishedTransform,
    RunningNode,
    RunningSystem,
    Starts,
    UnknownStart,
)
from sambot_viz.checks.around.workspace import Workspace
from sambot_viz.robot.packages.package_index import package_around

__all__ = [
    "Endpoint",
    "GivenParameter",
    "PublishedTransform",
    "RunningNode",
    "RunningSystem",
    "Starts",
    "UnknownStart",
    "running_system",
]


def running_system(
    path: Path,
    *,
    arguments: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    workspace: Sequence[Path | str] = (),
    trusted: bool = True,
) -> RunningSystem:
    """Return what a launch file or the launch files of a package start.

    Args:
        path: a launch file in a package, or a package.
        arguments: values for launch arguments, as `ros2 launch` takes them.
        package_path: as for `check`.
        workspace: as for `check`.
        trusted: as for `check`.
    """
    is_folder = path.is_dir()
    start = path if is_folder else path.absolute().parent
    found = Workspace(
        start,
        package_path,
        workspace,
        relative=not path.is_absolute(),
        trusted=trusted,
    )
    package = found.at(package_around(start) or start)
    if package is None:
        return RunningSystem()
    files = [
        (package, each)
        for each in package.launch_paths
        if is_folder or (package.folder / each).samefile(path)
    ]
    others = (each for each in found.given if each is not package)
    return system_of(
        files, [package, *others], found.named, arguments=arguments, displays=True
    )
