"""A server that shows a model and a config, again after each save."""

from __future__ import annotations

import os.path
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.displays.robot_display import Description
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.errors import JointError, Problem, RobotError, UsageError
from sambot_viz.inputs import Inputs, bundled_config
from sambot_viz.panels.saved_pictures import AskPage
from sambot_viz.robot.model import Robot
from sambot_viz.robot.model_source import open_text
from sambot_viz.rviz import DisplayConfig, RvizConfig
from sambot_viz.server import reload_problems
from sambot_viz.server.config_store import ConfigStore, Sources
from sambot_viz.server.listener import Listener
from sambot_viz.server.live_model import FRAMES_WITHIN, LiveModel
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.reference import ReferenceModel
from sambot_viz.server.reload import Reloader
from sambot_viz.server.server import Server
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.editor.model_files import ModelFiles
from sambot_viz.session.first_sight import is_map, show_topics
from sambot_viz.session.model_edits import ModelEdits
from sambot_viz.session.own_config import fit_own_config, fit_robot
from sambot_viz.session.undo import History
from sambot_viz.topics.robot_topics import STAND_IN_LINK, STAND_IN_NAME, RobotTopics
from sambot_viz.topics.source_robot import SourceRobot

# Most servers show no recording.
if TYPE_CHECKING:
    from sambot_viz.server.recordings import Recordings

PANELS_WITHOUT_ROBOT = 1.0
"""If a model takes longer to load, the page shows its panels before the robot [s]."""


class ShownInputs:
    """A server for the opened inputs; `start` shows them.

    Args:
        inputs: the model and the config, with their options. If the inputs may be
            broken, the page shows their problems, and draws them once they are fixed.
        listening: a server that already listens, to use in place of the options' host
            and port; it stops with this one.
        ask_page: exports the visible state as a page.

    Attributes:
        configs: the shown config, and its file.
        server: the server that browsers open.

    Raises:
        SambotVizError: as the constructor of `Visualizer`.
    """

    def __init__(
        self, inputs: Inputs, listening: Listener | None, ask_page: AskPage
    ) -> None:
        options = inputs.options
        inputs.begin()
        document = inputs.document()
        prepare = partial(_set_fixed_frame, fixed_frame=options.fixed_frame)
        prepare(document)
        self._inputs = inputs
        self.configs = ConfigStore(
            document, options.session == "shared", prepare, inputs.config
        )
        self._stand_in = document if inputs.takes_bundled_config else None
        if self._stand_in is not None and inputs.moved_by is not None:
            self._show_data(document, inputs.moved_by)
        self._stand_in_frame = document.global_options.get("Fixed Frame")
        self._assume_frame(document, inputs.moved_by)
        # Switched off for a live robot without a description so far.
        self._switched_off: list[DisplayConfig] = []
        # Root and top frame of the live robot to which config and cameras were fitted.
        self._ends_of_live: tuple[str, str] | None = None
        self._reloader: Reloader | None = None
        self._live_model: LiveModel | None = None
        is_recorded = inputs.moved_by is not None and inputs.live is None
        self._recordings: Recordings | None = None
        if is_recorded:
            from sambot_viz.server.recordings import Recordings

            self._recordings = Recordings(inputs, self.configs, self._first_config)
        models = ModelThread(inputs.load, options.package_path, self._load_described)
        self.server = Server(
            options,
            self.configs,
            models,
            listening,
            inputs.presets(),
            self.configs,
            ask_page,
            inputs.moved_by,
            self._recordings,
        )
        if inputs.model is not None and os.path.isfile(inputs.model):
            # A program may change its working directory.
            model, study = inputs.model.absolute(), options.study
            self.server.sessions.model_files = ModelFiles(
                model,
                inputs.load,
                options.xacro_args,
                None if study is None else study.folder,
                tuple if study is None else study.texts,
                options.trusted,
            )
        if inputs.reference is not None:
            reference = ReferenceModel(inputs.reference, inputs.load)
            self.server.sessions.reference = reference
        if options.edit and inputs.model is not None:
            folder = None if options.study is None else options.study.folder
            edits = ModelEdits(inputs.model, options.watch, folder)
            self.server.sessions.edits = edits

    def start(self) -> None:
        """Show the robot, and follow the files if the options say so.

        Raises:
            RobotError: the model cannot be shown; the server has stopped.
        """
        inputs, clients = self._inputs, self.server.clients
        try:
            if not inputs.wait(PANELS_WITHOUT_ROBOT):
                clients.show_panels()
            refusal = inputs.refusal()
            if refusal is None:
                self._show(inputs.robot())
            clients.show_panels()
            self._show_reference()
            # A given model is followed beside a live robot, too; without one, the
            # description of the live robot is.
            is_own = inputs.live is None or inputs.model is not None
            if inputs.options.watch and is_own:
                self._follow(refusal)
            if inputs.live is not None:
                self._follow_live(inputs.live)
        except BaseException:
            self.server.stop()
            raise

    def open_recording(self, path: Path, source: str | None) -> None:
        """Show another recording in all sessions; see `Recordings.open`."""
        if self._recordings is None:
            raise UsageError(
                "no recording is shown that another one could replace: start with one, "
                "as the model or the source, and without a live robot"
            )
        self._recordings.open(self.server.sessions, path, source)

    def stop(self) -> None:
        """Stop the server and free the port; further calls do nothing."""
        if self._reloader is not None:
            self._reloader.close()
        if self._live_model is not None:
            self._live_model.close()
        # Sessions read the sources until they end.
        self.server.stop()
        self._inputs.close()

    def _show(self, robot: Robot) -> None:
        """Show a robot; fit the bundled config, made for sam_bot, to the first one."""
        sessions, moved_by = self.server.sessions, self._inputs.moved_by
        if sessions.robot is None and self._stand_in is self.configs.current:
            self._fit_fixed_frame(self.configs.current, robot, moved_by)
            for session in sessions.all():
                shown = session.document
                with session.change(shown.options, shown.displays):
                    self._fit_fixed_frame(session.document.config, robot, moved_by)
                    session.scene.apply_enabled()
        sessions.show_robot(robot)

    def _show_reference(self) -> None:
        """Read the reference, and compare all sessions with it.

        Raises:
            RobotError: the reference cannot be shown, and inputs may not be broken.
        """
        sessions = self.server.sessions
        if (reference := sessions.reference) is None:
            return
        refusal = reference.read()
        if refusal is not None and not self._inputs.may_be_broken:
            raise refusal
        sessions.set_reload_problems("reference", reference.problems)
        sessions.show_reference()

    def _first_config(self, moved_by: SourceRobot, robot: Robot | None) -> RvizConfig:
        """Return the bundled config, fitted to other sources."""
        document = bundled_config()
        _set_fixed_frame(document, self._inputs.options.fixed_frame)
        self._show_data(document, moved_by)
        self._assume_frame(document, moved_by)
        if robot is not None:
            self._fit_fixed_frame(document, robot, moved_by)
        return document

    def _follow_live(self, live: SourceRobot) -> None:
        """Connect to a live robot, and show it by its own description."""
        show = self._show_live if self._inputs.options.model is None else None
        load, refuse = self._inputs.load_described, self._refuse_live
        self._live_model = LiveModel(live, load, show, refuse)
        if self._inputs.options.record is not None:
            assert live.recorder is not None
            live.recorder.start(Path(self._inputs.options.record))
        if self._stand_in is not None:
            live.on_topics.append(partial(self._post_data, live))
        live.source.open()

    def _show_data(self, document: RvizConfig, moved_by: SourceRobot) -> None:
        """Show the data of the sources in the bundled config."""
        points_of = moved_by.first_messages.points_of
        robots = moved_by.topics.descriptions
        show_topics(document, moved_by.types, points_of, robots, moved_by.loose)
        missing = moved_by.description is None and self._inputs.options.model is None
        document.fits_frames = missing and moved_by.can("seek")
        if document.fits_frames:
            _without_robot(document)

    def _take_frame(
        self, shown: ShownDocument, history: History, live: SourceRobot
    ) -> None:
        """Show the frames of a live robot that sends no description."""
        top, document = live.top_of_frames(), shown.config
        fixed = document.global_options.get("Fixed Frame")
        if live.topics.description is None and top and fixed == STAND_IN_LINK:
            # The program does this, not a user, so no user should undo it.
            with history.unrecorded():
                shown.set_option("Fixed Frame", top)
            if self._inputs.options.model is None:
                self._switched_off += _without_robot(document)
                shown.show()

    def _post_data(self, live: SourceRobot) -> None:
        """Show a live robot's data in all sessions; runs in the source's thread."""
        if self._stand_in is not self.configs.current:
            return
        for session in self.server.sessions.all():
            show = partial(self._show_live_data, session.document, live)
            session.worker.post(show)
            # Its transforms, which reveal the top frame, come a little later.
            take_frame = partial(
                self._take_frame, session.document, session.history, live
            )
            session.worker.post_later(FRAMES_WITHIN, take_frame)

    def _show_live_data(self, shown: ShownDocument, live: SourceRobot) -> None:
        before = len(shown.config.unasked)
        self._show_data(shown.config, live)
        if len(shown.config.unasked) > before:
            shown.show()

    def _load_described(self, described: Description) -> Robot:
        """Load the robot on a topic that is not the opened one."""
        text = described.text or ""
        if self._live_model is not None:
            return self._live_model.load(text, described.label)
        return self._inputs.load(open_text(text, described.label), trusted=False)

    def _show_live(
        self, robot: Robot, root: str, top: str, missing: tuple[Problem, ...]
    ) -> None:
        sessions = self.server.sessions
        live = self._inputs.live
        topics = RobotTopics() if live is None else live.topics
        sessions.set_reload_problems("model", (*missing, *self._start_problems(robot)))
        # A repeated description of the same robot keeps the users' choices.
        is_another, self._ends_of_live = (root, top) != self._ends_of_live, (root, top)
        if is_another and self._stand_in is self.configs.current:
            for session in sessions.all():
                shown = session.document
                with session.change(shown.options, shown.displays, shown.views):
                    self._fit_live(session.document.config, robot, top, root)
                    _name_description(session.document.config, topics)
                    session.scene.apply_enabled()
            self._fit_live(self.configs.current, robot, top, root)
            _name_description(self.configs.current, topics)
        sessions.show_robot(robot)
        # Pages opened before the robot came look at an empty place.
        for session in sessions.all() if is_another else ():
            with session.change():
                session.clients.show_first_view()

    def _start_problems(self, robot: Robot) -> tuple[Problem, ...]:
        """Report joints of the command line that a live robot does not have."""
        try:
            self._inputs.options.start_pose.state(robot)
        except JointError as error:
            return (reload_problems.start_pose(error),)
        return ()

    def _refuse_live(self, error: RobotError) -> None:
        self.server.sessions.set_reload_problems("model", error.problems)

    def _fit_live(
        self, document: RvizConfig, robot: Robot, top: str, root: str
    ) -> None:
        """Fit a config to a live robot, unless a user has chosen a frame."""
        given = self._inputs.options.fixed_frame
        fixed = document.global_options.get("Fixed Frame")
        if fixed in (STAND_IN_LINK, root, top, given):
            _show_motion(document, robot, top, root)
            fit_robot(document, robot)
            _set_fixed_frame(document, given)
        for display in document.displays:
            if display.kind == RobotModelDisplay.kind and display in self._switched_off:
                display.set_enabled(True)
        self._switched_off.clear()

    def _fit_fixed_frame(
        self, document: RvizConfig, robot: Robot, moved_by: SourceRobot | None
    ) -> None:
        """Make the root of a robot the fixed frame, unless a user has chosen one."""
        if document.global_options.get("Fixed Frame") == self._stand_in_frame:
            fit_own_config(document, robot)
            if moved_by is not None and moved_by.can("seek"):
                _name_description(document, moved_by.topics)
                root, top = moved_by.root_and_top(robot)
                _show_motion(document, robot, top, root)
            _set_fixed_frame(document, self._inputs.options.fixed_frame)
            self._assume_frame(document, moved_by)

    def _assume_frame(self, document: RvizConfig, moved_by: SourceRobot | None) -> None:
        """Mark the fixed frame of the bundled config as not chosen by a user."""
        # The data of a live robot come later.
        is_whole = moved_by is None or moved_by.can("seek")
        is_asked = self._inputs.options.fixed_frame is not None
        if self._stand_in is not None and is_whole and not is_asked:
            document.assumed_frame = str(document.global_options.get("Fixed Frame"))

    def _follow(self, refusal: RobotError | None) -> None:
        """Show the files again after each save."""
        inputs = self._inputs
        # A program may change its working directory.
        model = None if inputs.model is None else inputs.model.absolute()
        sources = Sources(model, inputs.load, self._show, self.configs, inputs.opened)
        reloader = Reloader(self.server.sessions, sources, inputs.options.on_reload)
        if refusal is not None:
            reloader.refuse_model(refusal)
        if inputs.broken_config is not None:
            reloader.refuse_config(inputs.broken_config)
        reloader.start()
        self._reloader = reloader


def _show_motion(document: RvizConfig, robot: Robot, top: str, root: str) -> None:
    """Show a robot's motion in a frame without letting it leave the picture."""
    document.global_options.set("Fixed Frame", top)
    # Without a robot, a map stays fixed, and moving data beside it shows the motion.
    has_map = any(is_map(display) for display in document.displays)
    if top != root and not (has_map and robot.name == STAND_IN_NAME):
        document.view.set("Target Frame", root)


def _without_robot(document: RvizConfig) -> list[DisplayConfig]:
    """Switch off displays of a robot that is missing and that no user has chosen."""
    shown = [
        display
        for display in document.displays
        if display.kind == RobotModelDisplay.kind and display.enabled
    ]
    for display in shown:
        display.set_enabled(False)
    return shown


def _name_description(document: RvizConfig, topics: RobotTopics) -> None:
    """Set a robot's description topic in a config for a robot without a namespace.

    Nothing changes if a robot without a namespace exists too, or a user has chosen a
    topic.
    """
    name = topics.description
    for display in document.displays:
        if name is not None and "Description Topic" in display.declared:
            if display.get("Description Topic") == "/robot_description":
                display.set("Description Topic", name)


def _set_fixed_frame(document: RvizConfig, fixed_frame: str | None) -> None:
    if fixed_frame is not None:
        document.global_options.set("Fixed Frame", fixed_frame)
