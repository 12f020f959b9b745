"""One robot, config, joints, frames and displays, shown to one audience.

The audience is all browsers (shared) or one (private): `viser.ViserServer` and
`viser.ClientHandle` have the same scene and GUI, so the same classes serve both.
All state of a session changes under its one lock. A single change is sent at once,
streams at the config's Frame Rate.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from types import MappingProxyType

import viser

from sambot_viz.displays.robot_display import ModelReader
from sambot_viz.displays.scene.session_assets import Reader
from sambot_viz.frames.robot_frames import floating_problems
from sambot_viz.joints.presets import Presets
from sambot_viz.meshes.cache import MeshCache
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.browser.browser import Browser
from sambot_viz.session.browser.pick_rays import PickRays
from sambot_viz.session.document.document_view import target_of, view_of
from sambot_viz.session.people.roles import Roles
from sambot_viz.session.problem_list import ProblemList
from sambot_viz.session.robot.motion import Motion
from sambot_viz.session.robot.robot_edits import RobotEdits
from sambot_viz.session.signals import Audience
from sambot_viz.session.worker import Worker
from sambot_viz.views.camera import Camera


class Session(RobotEdits):
    """One robot and its displays, shown to one audience.

    Args:
        audience: where to draw.
        worker: the thread that browsers, timers and files act in; it is closed with
            the session.
        config: the .rviz document; the session changes it as the user does.
        meshes: mesh files that are read already (shared by all sessions).
        models: reads other models, for a RobotModel from a file.
        reader: reads mesh files in the background; None reads them while drawing.
        options: the start pose, the static transforms and the wheels.
        poses: the named poses; None keeps new ones in memory.

    Attributes:
        roles: who of the browsers may change the session.
        browser_listeners: called with a browser that joined (True) or left (False),
            with the session locked.

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
    ) -> None:
        poses = poses or Presets()
        super().__init__(audience, worker, config, meshes, models, reader, poses)
        self.options = options or Options()
        self.problems = ProblemList(self)
        worker.on_error = self.problems.report_error
        self.motion = Motion(self)
        self.rays = PickRays(self)
        self._browsers: dict[int, Browser] = {}
        self.browser_listeners: list[Callable[[Browser, bool], None]] = []
        self._open = threading.Semaphore()
        private = isinstance(audience, viser.ClientHandle)
        presented = self.options.presenter is not None and not private
        self.roles = Roles(self.change, presented)
        for added in self.options.transforms:
            self.add_frame(added.parent, added.child, added.transform)

    # Browsers

    @property
    def browsers(self) -> Mapping[int, Browser]:
        """The browsers that see the session, by their numbers; read-only."""
        return MappingProxyType(self._browsers)

    def join_browser(
        self, client: viser.ClientHandle, *, presenter: bool = False
    ) -> Browser:
        """A browser has opened the page, maybe by the presenter's link."""
        with self.lock:
            self.roles.join(client.client_id, presenter)
            browser = self._browsers[client.client_id] = Browser(self, client)
            for listener in tuple(self.browser_listeners):
                listener(browser, True)
            return browser

    def leave_browser(self, client_id: int) -> None:
        """A browser has closed the page: what belongs to it alone is forgotten."""
        with self.lock:
            browser = self._browsers.pop(client_id, None)
            if browser is not None:
                browser.close()
                self.history.leave(client_id)
                self.roles.leave(client_id)
                for listener in tuple(self.browser_listeners):
                    listener(browser, False)

    @property
    def camera(self) -> Camera:
        """The camera of the document's view, in the fixed frame."""
        view = view_of(self.config.view)
        return view.camera(target_of(self, view))

    def camera_on_robot(self, width: int, height: int) -> Camera:
        """That camera, moved to where it shows the whole robot.

        Args:
            width: of the picture [pixels].
            height: of the picture [pixels].
        """
        view = view_of(self.config.detached_view())
        target, box = target_of(self, view), self.rays.robot_box()
        if box is not None:
            for path, value in view.fit(*box, width, height, target).items():
                view.config.set(path, value)
        return view.camera(target)

    def show_view(self) -> None:
        """Give all browsers the document's view, which `set_config` does not."""
        with self.change():
            for browser in self._browsers.values():
                browser.view.show()

    # The robot

    def show_robot(self, robot: Robot) -> None:
        """Show a robot, or the same after an edit: joints keep their values."""
        with self.change(self.signals.robot):
            self.context.robot = robot
            self.context.assets.look_again()
            self._posed.take(robot, self.options.start_pose)
            self.motion.drive.take(robot)
            refused = self._posed.build_tree()
            self.context.moving = self._posed.moving
            self.drawn.publish()
            self.drawn.take_options()
            wheels = self.motion.drive.problems
            self.problems.of_frames = (*floating_problems(robot), *refused, *wheels)
            of_joints = self.joints.problems if self.joints else ()
            self.problems.set_model((*robot.problems, *of_joints))
            self._frames_changed()

    def close(self) -> None:
        """Send nothing any more; a second call does nothing.

        The browser of a private session may leave while the server stops.
        """
        if not self._open.acquire(blocking=False):
            return
        self.context.apply = lambda action: None
        self.motion.close()
        for browser in self._browsers.values():
            browser.close()
        self.rays.close()
        self._pacer.close()
        self.worker.close()
