"""One robot, config, joints, frames and displays, shown to one audience.

The audience is all clients (shared) or one (private): `viser.ViserServer` and
`viser.ClientHandle` have the same scene and GUI, so the same classes serve both.
All state of a session changes under its one lock. A single change is sent at once,
streams at the config's Frame Rate.
"""

from __future__ import annotations

import threading
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import viser

from sambot_viz.displays.robot_display import ModelReader
from sambot_viz.displays.scene.session_assets import Reader
from sambot_viz.frames import FrameTree
from sambot_viz.frames.data_frames import DataFrames
from sambot_viz.frames.history import FrameHistory
from sambot_viz.frames.robot_frames import floating_problems
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.publishing.publisher import DriveSettings, publisher_of
from sambot_viz.publishing.sent_lines import SentLines
from sambot_viz.publishing.sent_message import SentMessage
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.clients import Clients
from sambot_viz.session.clients.follow_view import FollowView
from sambot_viz.session.comparison import Comparison, ComparisonChoice
from sambot_viz.session.data.robot_data import RobotData
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.document.display_edits import DisplayEdits
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.document_view import DocumentView
from sambot_viz.session.document.toggles import Toggles
from sambot_viz.session.own_config import SizeOfRobot, is_own_config
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.people.turns import Turns
from sambot_viz.session.robot.joints_out import JointsOut
from sambot_viz.session.robot.motion import Motion
from sambot_viz.session.robot.robot_drive import Drive, DriveTrail
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.robot.session_frames import Frames
from sambot_viz.session.robot.user_frames import UserFrames
from sambot_viz.session.scene.goal_mark import GoalMark
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.session_copy import SessionCopy
from sambot_viz.session.session_graph import SessionGraph
from sambot_viz.session.shown_problems import Checks, Problems
from sambot_viz.session.signals import Audience, Change, Signal, connect
from sambot_viz.session.undo import History
from sambot_viz.session.worker import Worker
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.views.camera import Camera


class Session:
    """Makes the parts of a session, and joins them; none of them knows it.

    Args:
        audience: where to draw.
        worker: the thread for actions of clients, timers and files; it is closed with
            the session.
        config: the .rviz document; the session changes it as the user does.
        meshes: mesh files that are read already (shared by all sessions).
        models: reads other models, for a RobotModel from a file.
        reader: reads mesh files in the background; None reads them while drawing.
        options: the start pose, the static transforms and the wheels.
        poses: the named poses; None keeps new ones in memory.
        moved_by: the robot of its sources, which moves this one; None leaves it to the
            sliders.

    Attributes:
        saved: the files that were last saved, by any program.
        lock: the worker's lock; held while the state changes.
        change: changes the state, sends the change, and emits its signals.
        private: whether only one client sees it.
        own_model: whether it shows its own robot instead of the server's.
        sources: the sources of messages, and the data that moves the robot.
        publisher: the way back to a live robot.
        joints_out: publishes the joints that users move.
        sent: the last messages to the robot; emitted with each.
        driven: drives the live robot by hand.
        graph: the nodes and topics of the package and of the robot.
        comparison: compares the robot with a reference.

    Raises:
        FrameError: static transforms that form a ring.
    """

    def __init__(
        self,
        audience: Audience,
        worker: Worker,
        config: RvizConfig,
        meshes: MeshCache,
        models: ModelReader | None = None,
        reader: Reader | None = None,
        options: Options | None = None,
        poses: Presets | None = None,
        moved_by: SourceRobot | None = None,
    ) -> None:
        self.audience, self.worker, self.lock = audience, worker, worker.lock
        self.options = options = options or Options()
        self.poses = poses or Presets()
        change = self.change = Change(worker, audience)
        self.fullscreen = options.fullscreen
        private = self.private = isinstance(audience, viser.ClientHandle)
        self.own_model = self._has_others = False
        presented = options.presenter is not None and not private
        self.roles = Roles(change, presented, not options.in_class)
        self.turns: Turns | None = None
        if presented and options.slot is not None:
            self.turns = Turns(self.roles, options.slot, worker)
        history = self.history = History(change)

        frames = None if moved_by is None else FrameHistory()
        tree = FrameTree(frames)
        scene = self.scene = Scene(audience, tree, change, meshes, models, reader)
        picker = self.picker = Picker(scene, worker)
        document = self.document = ShownDocument(config, scene, history, change)
        self.document_view = DocumentView(document, scene, picker)
        self.display_edits = DisplayEdits(document, scene, history, change)
        self.toggles = Toggles(document, scene, self.display_edits)

        added = UserFrames(tree)
        data_frames = DataFrames(tree)
        robot = RobotState(tree, added, data_frames, scene, history, change, worker)
        self.robot = robot
        self._size = SizeOfRobot(
            document, scene, robot, picker, self.display_edits, history
        )
        is_given = options.model is not None
        self.sources = SessionSources(
            frames, data_frames, robot, scene, change, worker, is_given
        )
        if moved_by is not None:
            self.sources.take(moved_by)
        self.frames = Frames(tree, added, robot, scene, history, change)
        self.drive = Drive(robot, self.frames, options, change)
        self.motion = Motion(robot, self.drive, change, worker)
        self._trail = DriveTrail(self.drive, robot, scene, change, worker)

        fixes = options.study is None or options.study.lesson.fixes
        self.problems = Problems(
            document, scene, robot, change, self.sources, options.notes, fixes
        )
        worker.on_error = self.problems.report_error
        worker.in_control = self.roles.may_edit
        self.checks = Checks(
            robot, document, scene, self.problems, change, options.workspace
        )
        first = "none" if options.reference is None else "reference"
        self.comparison = Comparison(
            robot, scene, change, self.problems.report_error, ComparisonChoice(first)
        )
        self.graph = SessionGraph(
            robot,
            self.problems,
            self.sources,
            change,
            worker,
            options,
        )
        self.driven = Signal(change, None)
        self.saved: Signal[frozenset[Path]] = Signal(change, frozenset())
        drive = DriveSettings(
            f"/{options.cmd_vel.strip().lstrip('/')}",
            (options.max_linear, options.max_angular),
            lambda: worker.post(self._tell_driven),
            worker.post,
        )
        self.publisher = publisher_of(
            options.publish, options.publish_log, tree, drive, is_private=private
        )
        self.publisher.name_of = self._name_of
        self.sent, self.sending = SentLines(), Signal(change, None)
        self.publisher.listeners.append(self._note_sent)
        self.joints_out = JointsOut(robot, self.publisher, change, worker)
        mark = GoalMark(self.publisher, scene, change)
        connect([self.driven, scene.frames], mark.draw)
        self._take_robot()
        self.clients = Clients(
            document,
            scene,
            robot,
            picker,
            history,
            self.roles,
            self.publisher,
            change,
            worker,
        )
        self.follow_view = FollowView(
            self.drive, document, scene, self.clients, picker, history, worker
        )

        self._open, self._closed = threading.Semaphore(), False
        connect([document.options, document.replaced], self._take_period)
        self._take_period()
        connect([document.time, self.sources.replaced], self._synchronize)
        self._synchronize()
        for frame in options.transforms:
            self.frames.add(frame.parent, frame.child, frame.transform)

    @property
    def data(self) -> RobotData | None:
        """What messages move; None without a source."""
        return self.sources.data

    def join(
        self,
        handle: viser.ClientHandle,
        *,
        presenter: bool = False,
        login: str = "",
        only_looks: bool = False,
    ) -> Client:
        """Add a client that has opened the page.

        Args:
            handle: the client.
            presenter: whether the page was opened by the presenter's link.
            login: the name by which a trusted proxy knows the user; "" without one.
            only_looks: whether it never has control.
        """
        with self.lock:
            self.roles.join(handle.client_id, presenter, login, only_looks)
            if self.data is not None:
                self.data.look(handle.client_id)
                self.data.begin()
            return self.clients.join(handle)

    @contextmanager
    def looked_at(self) -> Generator[None]:
        """Draw all that there is, also without a page, until the end of the block."""
        viewer = object()
        with self.lock:
            if self.data is not None:
                self.data.look(viewer)
        try:
            yield
        finally:
            with self.lock:
                if self.data is not None:
                    self.data.leave(viewer)

    def take_camera(self, client_id: int, number: int, camera: Camera) -> None:
        """Accept a page's report of its camera; see `ClientCamera.take`."""
        client = self.clients.all.get(client_id)
        if client is not None:
            client.view.take_report(number, camera)

    def leave(self, client_id: int) -> None:
        """Forget what belongs to a client that has closed the page."""
        with self.lock:
            self.clients.leave(client_id)
            self.roles.leave(client_id)
            if self.data is not None:
                self.data.leave(client_id)

    def show_robot(self, robot: Robot, *, own: bool = False) -> None:
        """Show a robot, or the same after an edit: joints keep their values.

        Args:
            robot: the server's, or one of this session.
            own: whether it is of this session; from then on the server's is ignored.
        """
        with self.change():
            if not own:
                self.comparison.take_saved(robot)
                if self.own_model:
                    return
            start = self.options.start_pose
            if self.options.waits_for_robot or self._has_others:
                # The server says what is wrong once it has come.
                start = start.known_in(robot)
            refused = self.robot.take(robot, start)
            self.own_model = own
            self.drive.take(robot)
            self.scene.take_options(self.document.config.global_options)
            wheels = self.drive.problems
            found = (*floating_problems(robot), *refused, *wheels)
            self.problems.of_frames = found
            joints = self.robot.joints
            self.problems.set_model(
                (*robot.problems, *(joints.problems if joints else ())), checking=True
            )
            self.scene.draw_frames()
            if self.data is not None:
                self.data.resume()

    def show_edited(self, robot: Robot, unsaved: bool) -> None:
        """Show a robot whose text was changed in this session.

        Args:
            robot: of the text.
            unsaved: whether it differs from that of the files; what the server shows
                is ignored as long as it does.
        """
        with self.change():
            self.own_model = False
            self.show_robot(robot, own=unsaved)

    def files_saved(self, files: frozenset[Path]) -> None:
        """Read again what was saved: robots of displays, and texts of the editor."""
        self.scene.files_saved(files)
        with self.change(self.saved):
            self.saved.set(files)

    def replace_sources(
        self,
        moved_by: SourceRobot,
        robot: Robot | None,
        document: RvizConfig | None = None,
        *,
        own: bool = False,
    ) -> None:
        """Show other sources, as if the session had begun with them.

        Frames that were added stay; so does the document, unless there is another one.

        Args:
            moved_by: the robot of the sources.
            robot: the robot to show, with all joints at their start.
            document: the config, in place of the program's; None keeps the shown one.
            own: as for `show_robot`.
        """
        with self.change():
            if self._closed:
                return
            if not is_own_config(self.document.config):
                # A user has opened one meanwhile.
                document = None
            self.motion.stop()
            self.scene.clear()
            self.robot.forget()
            self.sources.take(moved_by)
            self._take_robot()
            self.own_model, self._has_others = False, True
            if document is None:
                self.document.show()
            else:
                self.document.replace(document)
            if robot is not None:
                self.show_robot(robot, own=own)
            if document is not None:
                self.clients.show_view()
            if self.data is not None and self.data.is_looked_at:
                self.data.begin()

    def copy(self) -> SessionCopy:
        """Return a copy of the shown state."""
        with self.lock:
            joints, context = self.robot.joints, self.scene.context
            data = self.data
            player = None if data is None else data.player
            return SessionCopy(
                config=self.document.config.copy(),
                positions={} if joints is None else dict(joints.positions),
                frames=dict(self.frames.added),
                poses=self.poses.in_memory(),
                config_file=context.config_file,
                trusted_files=context.trusted_files,
                robot=self.robot.model,
                own_model=self.own_model,
                link_colors=dict(context.link_colors),
                highlighted=frozenset(context.highlighted),
                trail=self.drive.trail,
                models=context.models,
                meshes=context.assets.cache,
                moved_by=None if data is None else data.moved_by,
                lease=None if data is None else data.moved_by.lease(),
                time_ns=0 if player is None else player.time_ns,
                follows=bool(self.robot.followed.value),
                texts=self.checks.texts,
                comparison=self.comparison.choice,
                moved=self.checks.moved,
            )

    def prepare(self, copy: SessionCopy) -> None:
        """Copy a program's settings from a copied session, before anything is drawn.

        The models that it trusts are trusted here; its document may name others, which
        a client has chosen.
        """
        context = self.scene.context
        self.checks.texts, self.checks.moved = copy.texts, copy.moved
        context.config_file = copy.config_file
        context.trusted_files = copy.trusted_files
        context.link_colors.update(copy.link_colors)
        context.highlighted.update(copy.highlighted)

    def take(self, copy: SessionCopy) -> None:
        """Put joints and frames where they are in a copy."""
        self.comparison.choose(copy.comparison)
        for child, frame in copy.frames.items():
            self.frames.add(frame.parent, child, frame.transform, static=frame.static)
        if self.data is not None:
            self.data.follow(copy.follows)
            if self.data.player is not None:
                self.data.player.jump(copy.time_ns)
        if self.robot.joints is not None:
            known = self.robot.joints.free
            self.robot.move({n: q for n, q in copy.positions.items() if n in known}, {})

    def close(self) -> None:
        """Stop sending for good; a second call does nothing.

        The client of a private session may leave while the server stops.
        """
        if not self._open.acquire(blocking=False):
            return
        self.scene.close()
        self.comparison.close()
        self.motion.close()
        self.joints_out.close()
        self._trail.close()
        self.follow_view.close()
        self.clients.close()
        self.picker.close()
        self.robot.close()
        with self.lock:
            self._closed = True
            self.publisher.close()
            self.sources.close()
        self.worker.close()

    def _take_robot(self) -> None:
        """Connect the publisher to the live robot among the sources, if any."""
        data = self.data
        if data is None or not data.moved_by.can("clock"):
            self.publisher.take(None, lambda: 0)
        else:
            self.publisher.take(data.moved_by, data.stamp_ns)
        self.joints_out.begin()

    def _note_sent(self, sent: SentMessage) -> None:
        with self.change(self.sending):
            self.sent.add(sent)

    def _tell_driven(self) -> None:
        with self.change(self.driven):
            pass

    def _name_of(self, client_id: int) -> str:
        person = self.roles.people.get(client_id)
        return "" if person is None else person.name

    def _synchronize(self) -> None:
        if self.data is not None:
            self.data.synchronize(*self.document.synchronization)

    def _take_period(self) -> None:
        self.robot.set_period(self.document.period)
        self.motion.period = self.document.period
        if self.data is not None:
            self.data.period = self.document.period
