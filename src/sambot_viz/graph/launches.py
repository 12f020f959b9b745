"""The launch files of a package, and what each of them would start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.checks.around.running import RunningSystem, running_system
from sambot_viz.graph.launch_names import is_launch_file
from sambot_viz.robot.packages.package_index import package_around


@dataclass(frozen=True, slots=True)
class StartedLaunch:
    """A launch file.

    Attributes:
        name: of the file, as the user would write it.
        package: the folder of its package.
        system: what it starts.
    """

    name: str
    package: Path
    system: RunningSystem

    def is_called(self, name: str) -> bool:
        """Return whether a user calls it so, with or without folder and ending."""
        short = Path(self.name).name
        return name in (self.name, short, short.split(".")[0])


def started_launches(
    path: Path,
    *,
    arguments: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    workspace: Sequence[Path | str] = (),
    trusted: bool = True,
) -> tuple[StartedLaunch, ...]:
    """Return what launch files start, first that which starts most.

    Args:
        path: a package, a launch file, or a model in a package.
        arguments: as for `running_system`.
        package_path: as for `check`.
        workspace: as for `check`.
        trusted: as for `check`.
    """

    def of(target: Path) -> RunningSystem:
        return running_system(
            target,
            arguments=arguments,
            package_path=package_path,
            workspace=workspace,
            trusted=trusted,
        )

    package = package_around(path) or (path if path.is_dir() else path.parent)
    if is_launch_file(path):
        return (StartedLaunch(str(path), package, of(path)),)
    names = of(path if path.is_dir() else package).launches
    found = [StartedLaunch(name, package, of(Path(name))) for name in names]
    return tuple(sorted(found, key=lambda one: (-len(one.system.started), one.name)))
