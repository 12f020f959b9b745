"""The model and the config to show: found, opened, and the robot loaded in a thread."""

from __future__ import annotations

import contextlib
import os.path
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, InvalidStateError, wait
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

from sambot_viz import bundled
from sambot_viz.errors import (
    ConfigError,
    Problem,
    RobotError,
    SourceError,
    UsageError,
)
from sambot_viz.moved_by import (
    named_descriptions,
    open_moved_by,
    open_recorded,
    refuse_mixture,
    refuse_time_of_live,
)
from sambot_viz.options import Options, PathLike
from sambot_viz.robot.model_source import (
    OpenedModel,
    looks_like_text,
    open_model,
    open_text,
)

# The page is there before what is only needed to draw in it has been imported.
if TYPE_CHECKING:
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    from sambot_viz.joints.presets import Presets
    from sambot_viz.listened import Listened
    from sambot_viz.moved_by import Given
    from sambot_viz.robot.model import Robot
    from sambot_viz.rviz import Declarations, RvizConfig
    from sambot_viz.rviz.yaml.yaml_document import Document
    from sambot_viz.topics.source_robot import SourceRobot


@cache
def declarations() -> Declarations:
    """Return the properties that displays, views and tools declare."""
    from sambot_viz.displays.registry import PROPERTIES
    from sambot_viz.rviz import Declarations
    from sambot_viz.tools.registry import TOOLS
    from sambot_viz.views.registry import VIEWS

    return Declarations(
        displays=PROPERTIES,
        views={kind: view.properties for kind, view in VIEWS.items()},
        tools={kind: tool.properties for kind, tool in TOOLS.items()},
    )


def load_config(path: Path | str) -> RvizConfig:
    """Read a .rviz file, of ROS 2 or ROS 1.

    Args:
        path: the file.

    Returns:
        The document; warnings about it are in `.problems`, and unsupported parts are
        kept for saving.

    Raises:
        ConfigError: the file cannot be read, or is not a .rviz document.
    """
    from sambot_viz.rviz import RvizConfig

    return RvizConfig.load(Path(path), declarations())


def bundled_config() -> RvizConfig:
    """Read the config that comes with the program.

    Raises:
        ConfigError: it cannot be read.
    """
    return load_config(bundled.config_path())


class Inputs:
    """The model and the config that `Options` name, opened.

    Each file is read once. Obvious errors (no such file, not XML, not a .rviz document)
    are raised here, before a server is started; `begin` loads the robot in a thread.

    Args:
        options: the user's options.
        may_be_broken: whether a model or a config with a mistake is shown with its
            problems, until it is fixed, rather than refused.
        listen: time for which a live robot is recorded, to use the result as a
            recording [s]; None follows it for good.

    Attributes:
        opened: when the files were opened [ns], as `time.time_ns` counts.
        model: the model file; None for a robot or a text from Python.
        config: the .rviz file, or None when none was named and none belongs to the
            model; the bundled one is used then.
        broken_config: why the config is not shown yet; only with `may_be_broken`.
        poses: the file for named poses, or None to keep them in memory.
        moved_by: the robot of the sources that move it; None without one.

    Raises:
        UsageError: a file does not exist, or the model is an object of a wrong type.
        SourceError: a recording cannot be opened, or no message of a live robot came.
        RobotError: the model is not XML, or ROS would refuse a `yourdfpy.URDF`.
        ConfigError: the config is not a .rviz document.
    """

    def __init__(
        self,
        options: Options,
        *,
        may_be_broken: bool = False,
        listen: float | None = None,
    ) -> None:
        self.opened = time.time_ns()
        self._options = options
        model, config = options.model, options.config
        text = model if isinstance(model, str) and looks_like_text(model) else None
        if listen is None:
            refuse_time_of_live(options)
        else:
            refuse_mixture(options)
        self.moved_by = open_moved_by(options)
        self._listened: Listened | None = None
        if self.live is not None and listen is not None:
            self._listen(self.live, listen)
        self._hold()
        found = self._find(
            Path(model) if isinstance(model, Path | str) and text is None else None,
            Path(config) if isinstance(config, Path | str) else None,
        )
        self.reference = self._find_reference()
        document = config is not None and not isinstance(config, Path | str)
        self.config = None if document else found.config
        self._document: Document | None = None
        self.broken_config: ConfigError | None = None
        if self.config is not None:
            self._open_config(self.config, may_be_broken)
        self._choose_robot()
        self._of_config: tuple[Problem, ...] = ()
        self.may_be_broken = may_be_broken
        self._robot: Future[Robot] = Future()
        self._load: Callable[[], Robot] | None = None
        if text is not None:
            self.model, self._may_be_broken = None, False
            self._open_model(text)
        elif model is None and (source := self.moved_by) is not None:
            self.model, self._may_be_broken = None, False
            self._load = partial(self._robot_of, source)
        elif model is None or isinstance(model, Path | str):
            self.model = found.model
            # A pipe of the shell can be read only once.
            self._may_be_broken = may_be_broken and os.path.isfile(found.model)
            self._open_model(found.model)
        else:
            self.model, self._may_be_broken = None, False
            robot, positions = _robot_of(model)
            self._robot.set_result(robot)
            if positions:
                positions.update(options.joint_positions)
                self._options = replace(options, joint_positions=positions)
        if options.look is None:
            # A config that is broken will be RViz's too.
            given = self.config is not None or config is not None
            look = "rviz" if given else "studio"
            self._options = self._options.having(look=look)
        self.poses = self._poses_file()
        self._presets: Presets | None = None

    @property
    def live(self) -> SourceRobot | None:
        """What moves it, if that is a live robot."""
        moved_by = self.moved_by
        return moved_by if moved_by is not None and moved_by.can("clock") else None

    @property
    def options(self) -> Options:
        """The options that the user gave, with the look that follows from them."""
        return self._options

    @property
    def takes_bundled_config(self) -> bool:
        """True for the bundled config, which was made for sam_bot."""
        missing = self.config is None and self._options.config is None
        return missing or self.broken_config is not None

    def begin(self) -> None:
        """Load the robot in a thread; a second call does nothing."""
        load, self._load = self._load, None
        if load is not None:
            _in_thread(load, self._robot)

    def robot(self) -> Robot:
        """Return the robot, as soon as it is loaded.

        Raises:
            RobotError: the model cannot be shown.
            KeyboardInterrupt: after `give_up`.
        """
        self.begin()
        return self._robot.result()

    def refusal(self) -> RobotError | None:
        """Return why there is no robot to show yet; None if there is one.

        Raises:
            RobotError: the model cannot be shown, and may not be broken.
            KeyboardInterrupt: after `give_up`.
        """
        try:
            self.robot()
        except RobotError as error:
            if not self._may_be_broken:
                raise
            return error
        return None

    def problems(self) -> tuple[Problem, ...]:
        """List the problems of the model, and of the config once it is a document.

        Raises:
            RobotError: as `refusal`.
        """
        refusal = self.refusal()
        of_model = self.robot().problems if refusal is None else refusal.problems
        broken = self.broken_config
        return (
            *self.problems_of_recording(),
            *of_model,
            *(self._of_config if broken is None else broken.problems),
        )

    def problems_of_recording(self) -> tuple[Problem, ...]:
        """List the problems of the recording."""
        if self.moved_by is None:
            return ()
        found = self.moved_by.problems
        if self._listened is not None:
            found = (*found, *self._listened.lost, *self._listened.missing)
        if self._options.model is None:
            return found
        return tuple(p for p in found if p.code != "no-description")

    def _find(self, model: Path | None, config: Path | None) -> bundled.Found:
        """Return the files that are meant; a package may start a model of another.

        Raises:
            UsageError: as `bundled.find`.
        """
        try:
            return bundled.find(model, config)
        except UsageError:
            if model is None or not os.path.isdir(model) or not self._options.trusted:
                raise
            from sambot_viz.checks.targets import find_targets

            started = find_targets(model, self._options.package_path).models
            if len(started) != 1:
                raise
            workspace = (*self._options.workspace, model)
            self._options = self._options.having(workspace=workspace)
            return bundled.Found(started[0].model, config or bundled.config_in(model))

    def _find_reference(self) -> Path | Robot | None:
        """Return the model to compare with, or its file.

        Raises:
            UsageError: as `bundled.find`.
        """
        given = self._options.reference
        if not isinstance(given, Path | str):
            return given
        try:
            return bundled.find(Path(given)).model
        except UsageError as error:
            raise UsageError(f"--reference: {error}") from error

    def wait(self, timeout: float) -> bool:
        """Wait for the robot to be loaded, or refused, at most so long [s].

        Returns:
            Whether `robot` answers at once now.
        """
        self.begin()
        return bool(wait([self._robot], timeout).done)

    def close(self) -> None:
        """Close recordings and connections; a second call does nothing."""
        if self.moved_by is not None:
            self.moved_by.close()
        self._lease = None
        if self._listened is not None:
            self._listened.close()

    def __enter__(self) -> Inputs:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()

    def give_up(self) -> None:
        """Make `robot` raise KeyboardInterrupt for whoever waits for it.

        The loading itself goes on in its thread until the program ends.
        """
        with contextlib.suppress(InvalidStateError):
            self._robot.set_exception(KeyboardInterrupt())

    def load(
        self,
        model: PathLike | OpenedModel,
        trusted: bool = True,
        edited: Mapping[str, str] | None = None,
        arguments: Mapping[str, str] | None = None,
    ) -> Robot:
        """Load a model with the xacro arguments and packages of the options.

        Args:
            model: the file.
            trusted: False for a file that a browser named, whose code must not run.
            edited: as for `load_robot`.
            arguments: in place of those xacro arguments that have the same name.

        Raises:
            RobotError: the model cannot be shown.
        """
        from sambot_viz.robot.model import load_robot

        packages = self._options.package_path
        if self._listened is not None:
            packages = (self._listened.packages, *packages)
        return load_robot(
            model,
            xacro_args={**self._options.xacro_args, **(arguments or {})},
            package_path=packages,
            trusted=trusted and self._options.trusted,
            edited=edited,
        )

    def load_described(self, model: OpenedModel, packages: Path) -> Robot:
        """Load a model that a live robot has described, with its packages.

        Raises:
            RobotError: the model cannot be shown.
        """
        from sambot_viz.robot.model import load_robot

        folders = (packages, *self._options.package_path)
        return load_robot(model, package_path=folders, trusted=False)

    def document(self) -> RvizConfig:
        """Return the config as a document; to be called once.

        The bundled one replaces a broken one.

        Raises:
            ConfigError: the bundled config cannot be read.
        """
        from sambot_viz.rviz import RvizConfig

        given = self._options.config
        if given is not None and not isinstance(given, Path | str):
            return given
        if self._document is None:
            return bundled_config()
        document = RvizConfig(self._document, declarations())
        self._of_config = document.problems
        return document

    def presets(self) -> Presets:
        """Return the named poses.

        Raises:
            JointError: their file holds something else.
        """
        if self._presets is None:
            from sambot_viz.joints.presets import Presets

            self._presets = Presets(self.poses)
        return self._presets

    def _listen(self, live: SourceRobot, seconds: float) -> None:
        """Record a live robot, and use the result as a recording.

        Raises:
            SourceError: no message has come.
        """
        from sambot_viz.listened import Listened
        from sambot_viz.topics.reasons import nothing_came

        listened = Listened(live, seconds, self._options.at)
        if listened.recorded is None:
            listened.close()
            lost = "".join(problem.message for problem in listened.lost)
            raise SourceError(f"{live.name}: {lost or nothing_came(seconds).text}")
        self._listened, self.moved_by = listened, listened.recorded

    def open_recordings(
        self, given: Given, named: Sequence[str]
    ) -> tuple[SourceRobot, Robot | None]:
        """Open other recordings than those of the options.

        Args:
            given: the recordings.
            named: descriptions that the config asks for.

        Returns:
            What moves the robot, and its robot; None where the options name one. It
            closes after whoever has a lease of it.

        Raises:
            SourceError: one of them cannot be opened.
        """
        moved_by = open_recorded(self._options, given)
        try:
            moved_by.choose(named)
            is_given = self._options.model is not None
            return moved_by, None if is_given else self._robot_of(moved_by)
        except BaseException:
            moved_by.close()
            raise

    def take(self, moved_by: SourceRobot) -> None:
        """Have others in the place of the sources of the options."""
        self.moved_by = moved_by
        self._hold()

    def _hold(self) -> None:
        moved_by = self.moved_by
        self._lease = None if moved_by is None else moved_by.lease()

    def _robot_of(self, source: SourceRobot) -> Robot:
        """Return the robot that a source describes.

        Where it cannot be shown, what else there is is shown with a stand-in.
        """
        # Whoever recorded it is not who reads it.
        try:
            return self.load(open_text(source.model, source.label), trusted=False)
        except RobotError as error:
            source.refusal = f"URDF failed Model parse: {error.problems[0].message}"
            stand_in = open_text(source.stand_in, source.label)
            robot = self.load(stand_in, trusted=False)
            return replace(robot, problems=(*error.problems, *robot.problems))

    def _choose_robot(self) -> None:
        """Take the robot whose topic the config names, where messages have several."""
        if self.moved_by is not None:
            given = self._options.config
            read = self._document if isinstance(given, Path | str | None) else given
            self.moved_by.choose(named_descriptions(read))

    def _open_model(self, model: PathLike) -> None:
        try:
            self._load = partial(self.load, open_model(model))
        except RobotError as error:
            if not self._may_be_broken:
                raise
            self._robot.set_exception(error)

    def _open_config(self, path: Path, may_be_broken: bool) -> None:
        from sambot_viz.rviz.yaml.yaml_document import Document

        try:
            self._document = Document.load(path)
        except ConfigError as error:
            if not may_be_broken:
                raise
            self.broken_config = error

    def _poses_file(self) -> Path | None:
        if self._options.poses is not None:
            return Path(self._options.poses)
        return None if self.model is None else bundled.poses_beside(self.model)


def _robot_of(model: Robot | yourdfpy.URDF) -> tuple[Robot, dict[str, float]]:
    """Return the robot of an object from Python, and where its joints are [rad or m].

    Joints that are at 0 are left out: they start as the robot's own do.
    """
    from sambot_viz.robot.model import Robot

    if isinstance(model, Robot):
        return model, {}
    import yourdfpy  # pyright: ignore[reportMissingTypeStubs]

    # Scripts that no type checker has read can give anything.
    if not isinstance(model, yourdfpy.URDF):  # pyright: ignore[reportUnnecessaryIsInstance]
        raise UsageError(
            f"model is of type {type(model).__name__}; give a file name, a Robot or a "
            "yourdfpy.URDF"
        )
    untyped: Any = model
    names, values = untyped.actuated_joint_names, untyped.cfg.tolist()
    positions = {name: q for name, q in zip(names, values, strict=True) if q}
    return Robot.from_yourdfpy(model), positions


def _in_thread(load: Callable[[], Robot], loading: Future[Robot]) -> None:
    """Load a robot in a daemon thread, so that a long one does not delay the end."""

    def run() -> None:
        try:
            robot = load()
        except BaseException as error:
            with contextlib.suppress(InvalidStateError):
                loading.set_exception(error)
        else:
            with contextlib.suppress(InvalidStateError):
                loading.set_result(robot)

    Thread(target=run, name="sambot-viz-load", daemon=True).start()
