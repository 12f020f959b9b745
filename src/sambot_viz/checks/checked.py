"""A whole check: models, and the packages that belong to them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.advice import with_edits
from sambot_viz.checks.copied_names import with_missing_names
from sambot_viz.checks.file_of_package import package_of_other
from sambot_viz.checks.launched_models import launched, load_launched, wrong_variants
from sambot_viz.checks.model_rules import (
    AROUND,
    RULES,
    find_problems,
    in_order,
    look,
    subject_of,
    with_proven_edits,
    without_followers,
)
from sambot_viz.checks.package_configs import (
    problems_of_configs,
    problems_without_robot,
)
from sambot_viz.checks.proven import lasting
from sambot_viz.checks.targets import CheckedModel, find_targets
from sambot_viz.checks.with_packages import Loaded, alone, proven_of_packages
from sambot_viz.errors import Problem, RobotError
from sambot_viz.files import each_file_once
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.robot.packages.package_index import package_around

if TYPE_CHECKING:
    from sambot_viz.checks.around.workspace import Package
    from sambot_viz.checks.rule import Subject


@dataclass(frozen=True, slots=True)
class Checked:
    """The checked models, and their problems.

    Attributes:
        models: the models.
        problems: errors first, then warnings, then notes; each in document order.
        package: the package of a file that is no model, which was checked with it.
        elsewhere: number of the problems in other files of that package.
    """

    models: tuple[CheckedModel, ...]
    problems: tuple[Problem, ...]
    package: Path | None = None
    elsewhere: int = 0


@each_file_once()
def check_all(
    path: Path,
    *,
    config: Path | None = None,
    xacro_args: Mapping[str, str] | None = None,
    package_path: Sequence[Path | str] = (),
    workspace: Sequence[Path | str] = (),
    trusted: bool = True,
) -> Checked:
    """Check like `check`, and also return the checked models.

    Raises:
        UsageError: a folder without anything to check, or with several models.
    """
    package = package_of_other(path) if trusted else None
    if package is not None:
        whole = check_all(
            package,
            config=config,
            xacro_args=xacro_args,
            package_path=package_path,
            workspace=workspace,
        )
        return _only_of(path, whole, package)
    targets = find_targets(path, package_path, workspace, trusted=trusted)
    problems: list[Problem] = []
    loaded: list[Loaded] = []
    for target in targets.models:
        load = partial(
            load_robot, target.model, package_path=package_path, trusted=trusted
        )
        variants, given = launched(target), xacro_args or {}
        try:
            robot = load_launched(load, target, variants[0], given)
        except RobotError as error:
            refused = lasting(with_edits(error.problems), load)
            problems += with_missing_names(refused, target)
            continue
        subject = subject_of(robot, target.model, None, target.packages)
        of_model = [*_of_files(subject), *find_problems(subject, RULES)]
        of_model = with_proven_edits(subject, with_edits(of_model))
        problems += of_model
        problems += wrong_variants(load, target, variants[1:], given, of_model)
        seen = look(AROUND, subject)
        around = without_followers(subject, AROUND, seen)
        configs = with_edits(problems_of_configs(target, robot, config))
        loaded.append(
            Loaded(target, subject, tuple(around), tuple(seen), tuple(configs))
        )
    problems += proven_of_packages(targets, loaded)
    for package in alone(targets, loaded):
        for found in problems_without_robot(package):
            problems += with_edits(found)
    return Checked(targets.models, tuple(in_order(problems)))


def _only_of(path: Path, whole: Checked, package: Path) -> Checked:
    """Return the part of the check of a package that is about one of its files."""
    file = path.absolute()
    own = [p for p in whole.problems if p.file and Path(p.file).absolute() == file]
    others = len(whole.problems) - len(own)
    return Checked(whole.models, tuple(own), package, others)


@each_file_once()
def problems_around(
    robot: Robot,
    model: Path,
    workspace: Sequence[Path | str] = (),
    read: set[Path] | None = None,
) -> list[Problem]:
    """Return the problems of the files around a model; see `check_around`."""
    trusted = robot.file_roots is None
    targets = find_targets(model, (), workspace, trusted=trusted, read=read)
    (target,) = targets.models
    subject = subject_of(robot, model, None, target.packages)
    seen = look(AROUND, subject)
    around = without_followers(subject, AROUND, seen)
    found = Loaded(target, subject, tuple(around), tuple(seen))
    return in_order(proven_of_packages(targets, [found]))


def frame_is_published(
    robot: Robot,
    frame: str,
    config: str | None = None,
    workspace: Sequence[Path | str] = (),
) -> bool:
    """Return whether the packages of a robot or of a config may publish a frame.

    Args:
        robot: the robot.
        frame: a frame that is not one of its links.
        config: the .rviz file, if there is one.
        workspace: as for `check`.
    """
    from sambot_viz.checks.around.frames.published import may_be_published
    from sambot_viz.checks.around.surroundings import Surroundings
    from sambot_viz.checks.around.workspace import Workspace

    trusted = robot.file_roots is None
    packages: list[Package] = []
    if robot.files:
        found = find_targets(robot.files[0], (), workspace, trusted=trusted)
        packages += found.models[0].packages
    folder = package_around(Path(config)) if config is not None and trusted else None
    if folder is not None:
        own = Workspace(folder).at(folder)
        if own is not None and all(p.folder != own.folder for p in packages):
            packages.append(own)
    around = Surroundings(robot, tuple(packages))
    return bool(packages) and may_be_published(around, frame)


def _of_files(subject: Subject) -> list[Problem]:
    """Return the problems of loading a model, as its installed package has it."""
    if not subject.packages:
        return list(subject.robot.problems)
    # Import late: many models have no package.
    from sambot_viz.checks.around.package_files.installed_meshes import (
        without_installed,
    )

    return without_installed(subject.robot.problems, subject)
