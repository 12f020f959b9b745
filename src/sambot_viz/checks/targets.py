"""Find the models of a check, and the packages that belong to each.

For a package without a model, the check takes the model that its launch files start. A
package whose launch files use the model's package belongs to the model: it has its
parameters.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from sambot_viz import bundled
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.rule import listed
from sambot_viz.errors import Problem
from sambot_viz.robot.packages.package_index import PackageIndex, package_around
from sambot_viz.robot.packages.package_model import (
    MODEL_ENDINGS,
    ModelWalk,
    choose_model,
    is_for_tests,
    is_model,
    is_scenery,
    model_ending,
    models_in,
)

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package, Workspace

_GIVE = "the robot's model and --workspace"
_MOST_MODELS = 12
"""Maximum number of models to check all, in a package without a main one."""
_LAUNCHES = (
    "launch.py",
    ".launch",
    "launch.xml",
    "launch.yaml",
    "launch.yml",
)


class CheckedModel(NamedTuple):
    """A model to check.

    Attributes:
        model: as the user would write it.
        opened_by: the launch file that opens it, when the user named only that
            package; else empty.
        packages: the packages that belong to it, its own first.
        is_main: it is the main model of its package, not one of several.
    """

    model: Path
    opened_by: str = ""
    packages: tuple[Package, ...] = ()
    is_main: bool = True


class Targets(NamedTuple):
    """The models and packages to check.

    Attributes:
        models: the models.
        packages: the packages, with or without a model, each once.
        notes: name the packages that the check reads without a model.
    """

    models: tuple[CheckedModel, ...]
    packages: tuple[Package, ...] = ()
    notes: tuple[Problem, ...] = ()

    def edited(self, files: Collection[Path]) -> Targets:
        """Return the same targets when some files have other texts; see `Package`."""
        workspace = self.packages[0].workspace if self.packages else None
        if workspace is None:
            return self
        other = workspace.edited(files)

        def now(packages: Sequence[Package]) -> tuple[Package, ...]:
            found = (other.at(each.folder) for each in packages)
            return tuple(package for package in found if package is not None)

        models = (one._replace(packages=now(one.packages)) for one in self.models)
        return Targets(tuple(models), now(self.packages), self.notes)


def find_targets(
    path: Path,
    package_path: Sequence[Path | str] = (),
    workspace: Sequence[Path | str] = (),
    *,
    trusted: bool = True,
    read: set[Path] | None = None,
) -> Targets:
    """Find the models and packages to check.

    Args:
        path: a model, a package, or a folder of packages.
        package_path: as for `check`.
        workspace: as for `check`.
        trusted: as for `check`.
        read: receives the files that the check looks for.

    Raises:
        UsageError: there is nothing to check, or the choice of the model is not clear.
    """
    is_folder = os.path.isdir(path)
    if not is_folder and package_around(path) is None:
        return Targets((CheckedModel(path),))
    # Import late: many models have no package.
    from sambot_viz.checks.around.workspace import Workspace

    found = Workspace(
        path if is_folder else path.absolute().parent,
        package_path,
        workspace,
        relative=not path.is_absolute(),
        trusted=trusted,
        read=read,
    )
    search = _TargetSearch(found, trusted)
    if not is_folder:
        return search.of_file(path)
    own = found.at(path)
    if own is not None:
        return search.of_packages([own], path)
    below = PackageIndex(None, [path]).below().values()
    packages = [found.at(f) for f in below if (f / "package.xml").is_file()]
    if not any(packages):
        return search.of_file(bundled.find(path).model)
    return search.of_packages([p for p in packages if p is not None], path)


class _Start(NamedTuple):
    """A model that a launch file opens.

    Attributes:
        file: the model.
        launch: the launch file, as the user would write it.
        through: the packages whose launch files are on the way to it.
    """

    file: Path
    launch: str
    through: tuple[Package, ...]


class _TargetSearch:
    """Finds models and packages; follows each launch file once."""

    def __init__(self, workspace: Workspace, trusted: bool) -> None:
        self._workspace = workspace
        self._trusted = trusted
        self._started: dict[Package, dict[Path, _Start]] = {}
        self._own: dict[Package, list[Path]] = {}
        self._asked: tuple[Package, ...] = ()

    def of_file(self, path: Path) -> Targets:
        """Return a model with the packages that belong to it."""
        folder = package_around(path)
        home = None if folder is None else self._workspace.at(folder)
        if home is None:
            return Targets((CheckedModel(path),))
        file = path.resolve()
        chosen = choose_model(home.folder, self._models_of(home))
        is_main = chosen is not None and chosen.resolve() == file
        target = CheckedModel(path, "", self._together(file, (home,)), is_main)
        return Targets((target,), target.packages)

    def of_packages(self, packages: Sequence[Package], folder: Path) -> Targets:
        """Return the models of packages, or those that their launch files start."""
        self._asked = tuple(packages)
        targets: dict[Path, CheckedModel] = {}
        notes: dict[Package, Problem] = {}
        for package in packages:
            found = list(self._of_package(package))
            if not found and len(packages) == 1:
                found = list(self._each_of(package))
            for target in found:
                file = target.model.resolve()
                targets[file] = _joined(targets.get(file), target)
            if found:
                continue
            models = self._models_of(package)
            if models or len(packages) == 1:
                notes[package] = _without_model(package, models)
        if not targets and not notes:
            notes[packages[0]] = _without_models(packages, folder)
        covered = {p for target in targets.values() for p in target.packages}
        return Targets(
            tuple(targets.values()),
            tuple(dict.fromkeys([*packages, *covered])),
            tuple(note for package, note in notes.items() if package not in covered),
        )

    def _of_package(self, package: Package) -> Iterator[CheckedModel]:
        shown = self._workspace.shown
        chosen = choose_model(package.folder, self._models_of(package))
        if chosen is not None:
            together = self._together(chosen.resolve(), (package,))
            yield CheckedModel(Path(shown(chosen)), "", together)
            return
        for file, start in self._robots(package).items():
            folder = package_around(start.file)
            home = None if folder is None else self._workspace.at(folder)
            # Only the model of an installed package counts.
            own = (home,) if home and self._workspace.named(home.name) is home else ()
            first = (*own, package, *start.through)
            together = self._together(file, tuple(dict.fromkeys(first)))
            yield CheckedModel(Path(shown(start.file)), start.launch, together)

    def _each_of(self, package: Package) -> Iterator[CheckedModel]:
        """Yield all models of a package, when they are few and none can be a part."""
        models = self._models_of(package)
        whole = all(model_ending(m.name) != ".xacro" for m in models)
        tests = any(is_for_tests(m.relative_to(package.folder)) for m in models)
        few = len(models) <= _MOST_MODELS
        for model in models if few and whole and not tests else ():
            together = self._together(model.resolve(), (package,))
            shown = Path(self._workspace.shown(model))
            yield CheckedModel(shown, "", together, is_main=False)

    def _models_of(self, package: Package) -> list[Path]:
        if package not in self._own:
            found = models_in(package.folder, ModelWalk())
            self._own[package] = [path for path in found if not is_scenery(path)]
        return self._own[package]

    def _together(self, model: Path, first: tuple[Package, ...]) -> tuple[Package, ...]:
        """Return the packages of a model: those that start it, and those they use.

        Args:
            model: the file, resolved.
            first: packages that are known to belong to it, its own first.
        """
        found = list(first)
        pool = dict.fromkeys([*self._asked, *self._workspace.given])
        for each in pool:
            if each not in found and self._is_for(each, model, first[0]):
                found.append(each)
        for package in tuple(found):
            for other in pool:
                of_it = other.name in package.uses and not other.launch_paths
                if of_it and other not in found and not self._models_of(other):
                    found.append(other)
        return tuple(found)

    def _is_for(self, package: Package, model: Path, home: Package) -> bool:
        """Return whether the launch files of a package start this model, and no other.

        The started model may be unknown where the package has only this one.
        """
        started = self._robots(package)
        if started or self._workspace.is_chosen(package):
            return not started or list(started) == [model]
        only = self._models_of(home) == [model] and not self._models_of(package)
        return only and home.name in package.uses

    def _robots(self, package: Package) -> dict[Path, _Start]:
        """Return the models that its launch files start, by file; URDF before SDF.

        SDF robots beside URDF robots are other objects in the world.
        """
        if package not in self._started:
            found = self._follow(package) if self._trusted else {}
            urdf = {f: s for f, s in found.items() if "sdf" not in model_ending(f.name)}
            self._started[package] = urdf or found
        return self._started[package]

    def _follow(self, package: Package) -> dict[Path, _Start]:
        """Follow the launch files of a package to the models that they open."""
        found: dict[Path, _Start] = {}
        waiting: deque[tuple[Package, str, str, tuple[Package, ...]]] = deque(
            (package, path, package.shown(path), (package,))
            for path in package.launch_paths
        )
        seen: set[tuple[Package, str]] = set()
        while waiting:
            owner, path, first, through = waiting.popleft()
            if (owner, path) in seen:
                continue
            seen.add((owner, path))
            for value in owner.launch_paths.get(path, ()):
                if value.endswith(_LAUNCHES):
                    other = self._launch_file(value)
                    if other is not None:
                        chain = (*through, other[0])
                        waiting.append((*other, first, chain))
                elif value.endswith(MODEL_ENDINGS):
                    file = self._workspace.file(value)
                    if file and is_model(file) and not is_scenery(file):
                        start = _Start(file, first, through)
                        found.setdefault(file.resolve(), start)
        return found

    def _launch_file(self, value: str) -> tuple[Package, str] | None:
        """Return the launch file of a package in the workspace, and the package."""
        name, _, below = value.removeprefix(SHARE).partition("/")
        package = self._workspace.named(name)
        for path in package.launch_paths if package is not None else ():
            same_name = path.rpartition("/")[2] == below.rpartition("/")[2]
            if package is not None and (path == below or same_name):
                return package, path
        return None


def _joined(before: CheckedModel | None, now: CheckedModel) -> CheckedModel:
    """Return one target for a model that several packages are about."""
    if before is None:
        return now
    opened_by = before.opened_by and now.opened_by
    packages = tuple(dict.fromkeys([*before.packages, *now.packages]))
    return CheckedModel(now.model, opened_by, packages)


def _without_model(package: Package, models: Sequence[Path]) -> Problem:
    """Note that the check reads the files of a package without a robot."""
    if models:
        names = listed(str(m.relative_to(package.folder)) for m in models)
        message = f"several models are in the package ({names}), and no launch file "
        message += "says which one is meant"
    else:
        message = f"the package {package.name} has no model, and its launch files open "
        message += "none that is here"
    return Problem(
        "info",
        "package-without-model",
        f"{message}: its files were checked without a robot",
        f"to check it with a robot, give {_GIVE} {package.shown('.')}",
        package.shown("package.xml"),
    )


def _without_models(packages: Sequence[Package], folder: Path) -> Problem:
    """Note the same for all packages below a folder."""
    return Problem(
        "info",
        "package-without-model",
        f"none of the {len(packages)} packages in {folder} has a model, or opens one "
        "that is here: their files were checked without a robot",
        f"to check them with a robot, give {_GIVE} {folder}",
    )
