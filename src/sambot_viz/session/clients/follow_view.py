"""Pan the cameras of clients, so that a robot that is driven stays in view."""

from __future__ import annotations

import numpy as np

from sambot_viz.drive.differential import PlanarPose
from sambot_viz.rviz import RvizConfig
from sambot_viz.session.clients import viser_camera
from sambot_viz.session.clients.client import Client
from sambot_viz.session.clients.clients import Clients
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.document.document_view import has_target
from sambot_viz.session.robot.robot_drive import ODOM, Drive
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Listening, connect
from sambot_viz.session.undo import History
from sambot_viz.session.worker import Throttle, Worker
from sambot_viz.views.camera import Camera, Vector, vector

PERIOD = 0.2
"""The robot is looked after at most this often [s]."""
MIDDLE = 0.8
"""A robot whose root leaves this part of the picture is brought back to its middle."""
_NOWHERE = vector(0.0, 0.0, 0.0)


class FollowView:
    """Follows the robot with the view of the client that drives.

    The camera stays where its user has put it, and moves only when the robot drives
    while it is out of the picture; it never goes nearer or farther. It follows from the
    beginning of a drive on, until a hand, or another view, turns away from the robot.
    Who opens the page after a drive sees the robot; and when the fixed frame changes,
    by undo too, a driven robot stays where it is in each picture.

    Args:
        drive: the robot that is driven.
        document: has the fixed frame.
        scene: where the robot is.
        clients: one of them drives.
        picker: finds how large the robot is.
        history: knows who acts.
        worker: looks after the robot.
    """

    def __init__(
        self,
        drive: Drive,
        document: ShownDocument,
        scene: Scene,
        clients: Clients,
        picker: Picker,
        history: History,
        worker: Worker,
    ) -> None:
        self._drive = drive
        self._document = document
        self._scene = scene
        self._context = scene.context
        self._clients = clients
        self._picker = picker
        self._around: tuple[Vector, ...] = ()
        self._history = history
        self._driver: int | None = None
        self._before: Vector | None = None
        self._following = False
        self._shown: Camera | None = None
        # By client: how far its camera was moved.
        self._panned: dict[int, Vector] = {}
        self._fixed_before: tuple[RvizConfig, str] | None = None
        self._fixed = (document.config, self._context.fixed_frame)
        self._looking = Throttle(worker, PERIOD, self._look_after)
        self._lock = worker.lock
        self._driving = Listening(self._looking.request)
        connect([document.options], self._stay_in_pictures)
        clients.listeners.append(self._welcome)

    def close(self) -> None:
        """Move no camera from now on."""
        self._driving.to()
        self._looking.close()

    def show_motion(self) -> bool:
        """Replace a fixed frame that moves with the robot by one that does not.

        This is an edit that can be undone. The robot stays in the picture of the client
        that drives.

        Returns:
            Whether the fixed frame was replaced.

        Raises:
            FrameError: the root link cannot be attached to odom.
        """
        with self._lock:
            if self._drive.wheels is None:
                return False
            self._drive.enter_odom()
            self.begin()
            fixed = self._context.fixed_frame
            if fixed not in self._context.tree.frames or not self._drive.carries(fixed):
                return False
            self._document.set_option("Fixed Frame", ODOM)
            self._fixed_before = (self._document.config, fixed)
            # Now, and not after all else: the next step is of a robot in the picture.
            self._stay_in_pictures()
            self._before = self._place()
            return True

    def begin(self) -> None:
        """Follow the robot with the view of the client that acts now."""
        self._driver = self._history.actor
        self._before = self._place()
        self._following = True
        self._shown = self._camera
        self._around = self._robot_around()
        self._driving.to(self._drive.pose_changed, self._scene.frames)

    def find(self, client_id: int | None = None) -> None:
        """Bring the robot to the middle of a client's picture, unless it is in it.

        Args:
            client_id: the client; None for the acting one.
        """
        with self._lock:
            who = self._history.actor if client_id is None else client_id
            client = None if who is None else self._clients.all.get(who)
            place = self._place()
            if client is None or place is None:
                return
            self._around = self._robot_around()
            if not self._is_seen(client, place):
                self._pan(client, place - client.view.camera.look_at)

    def back_to_start(self) -> str:
        """Put the robot back, and undo what driving has changed.

        That is the fixed frame, the way of the camera and the frame odom. Fixed frame
        and odom change by edits that can be undone; odom stays while the fixed frame is
        odom or something else is in it. Who looks at the robot looks at it there.

        Returns:
            The fixed frame that was put back; "" if it stays.
        """
        with self._lock:
            self._drive.draw()
            before = self._place()
            saw = [
                client
                for number, client in self._clients.all.items()
                if number not in self._panned
                and before is not None
                and _shows(client, before)
                and not has_target(self._scene, client.view.view)
            ]
            self._drive.reset()
            self._drive.draw()
            place = self._place()
            if before is not None and place is not None:
                way = vector(place[0] - before[0], place[1] - before[1], 0.0)
                for client in saw:
                    middle = client.view.camera.look_at
                    # Its page was loaded meanwhile, or its user has gone along.
                    if _apart(middle, before) < _apart(middle, place):
                        client.view.pan(way)
            return self._put_back()

    def _put_back(self) -> str:
        with self._lock:
            self._driving.to()
            for client_id, way in self._panned.items():
                client = self._clients.all.get(client_id)
                if client is not None:
                    self._pan(client, -way)
            self._driver, self._panned = None, {}
            before, self._fixed_before = self._fixed_before, None
            put_back = ""
            if before is not None and self._context.fixed_frame == ODOM:
                config, fixed = before
                if config is self._document.config:
                    self._document.set_option("Fixed Frame", fixed)
                    put_back = fixed
            if self._context.fixed_frame != ODOM:
                self._drive.leave_odom()
            return put_back

    def follow(self, place: Vector | None) -> None:
        """Bring the robot back when it moves and is not in the picture.

        Args:
            place: of the robot in the fixed frame [m]; None when it has none.
        """
        before, self._before = self._before, place
        client = self._client
        if client is None or before is None or place is None:
            return
        if self._camera is not self._shown:
            # A user has moved it: to the robot, or away from it.
            self._shown, self._following = self._camera, _shows(client, before)
        if self._is_seen(client, place):
            self._following = True
        elif self._following and not np.array_equal(place, before):
            self._pan(client, place - client.view.camera.look_at)

    def _welcome(self, client: Client, joined: bool) -> None:
        """Show the robot to a client that comes after a drive."""
        if not joined:
            self._panned.pop(client.client_id, None)
        elif self._was_driven and not self._clients.leading.value:
            # A page that comes back has a camera, and asks by itself.
            if viser_camera.is_fresh(client.client.camera):
                self.find(client.client_id)

    def _stay_in_pictures(self) -> None:
        """Leave a driven robot where it is in each picture, in another fixed frame."""
        (document, old), tree = self._fixed, self._context.tree
        self._fixed = (self._document.config, self._context.fixed_frame)
        root, new = self._drive.root, self._context.fixed_frame
        if document is not self._document.config or old == new or not self._was_driven:
            return
        if not (tree.can_lookup(old, root) and tree.can_lookup(new, root)):
            return
        before = tree.lookup(old, root).matrix[:3, 3]
        way = tree.lookup(new, root).matrix[:3, 3] - before
        # A client that is led has its leader's camera before its turn.
        wanted = [
            (client, client.view.camera.look_at + way)
            for client in self._clients.all.values()
            if _shows(client, before) and not has_target(self._scene, client.view.view)
        ]
        for client, look_at in wanted:
            self._pan(client, look_at - client.view.camera.look_at)

    @property
    def _was_driven(self) -> bool:
        return bool(self._drive.root) and self._drive.pose != PlanarPose()

    def _pan(self, client: Client, away: Vector) -> None:
        """Move the camera of a client along the floor [m]."""
        level = vector(away[0], away[1], 0.0)
        if level.any():
            client.view.pan(level)
            number = client.client_id
            self._panned[number] = self._panned.get(number, _NOWHERE) + level
            if number == self._driver:
                self._shown = self._camera

    def _robot_around(self) -> tuple[Vector, ...]:
        """Return points around the robot however it turns, from its root link [m]."""
        place, box = self._place(), self._picker.robot_box()
        if place is None or box is None:
            return ()
        away = np.maximum(np.abs(box[0] - place), np.abs(box[1] - place))
        reach = float(np.hypot(away[0], away[1]))
        sides = ((reach, 0.0), (-reach, 0.0), (0.0, reach), (0.0, -reach))
        heights = (float(box[0][2] - place[2]), float(box[1][2] - place[2]))
        return tuple(vector(x, y, z) for x, y in sides for z in heights)

    def _is_seen(self, client: Client, place: Vector) -> bool:
        """Return whether the robot is in the picture; its root, if it is larger."""
        middle = client.view.camera.look_at
        level = vector(middle[0], middle[1], place[2])
        fits = all(_shows(client, level + away) for away in self._around)
        whole = not fits or all(_shows(client, place + away) for away in self._around)
        return whole and _shows(client, place, MIDDLE)

    def _look_after(self) -> None:
        with self._lock:
            self.follow(self._place())

    def _place(self) -> Vector | None:
        """Return where the root link is in the fixed frame [m]."""
        tree, fixed = self._context.tree, self._context.fixed_frame
        root = self._drive.root
        if not root or not tree.can_lookup(fixed, root):
            return None
        return tree.lookup(fixed, root).matrix[:3, 3]

    @property
    def _camera(self) -> Camera | None:
        """The camera of the client that drives; another object once it was moved."""
        client = self._client
        return None if client is None else client.view.shown.camera

    @property
    def _client(self) -> Client | None:
        return None if self._driver is None else self._clients.all.get(self._driver)


def _apart(one: Vector, other: Vector) -> float:
    """Return how far apart two points are on the floor [m]."""
    return float(np.hypot(one[0] - other[0], one[1] - other[1]))


def _shows(client: Client, point: Vector, part: float = 1.0) -> bool:
    window = client.client.camera
    width, height = max(1, window.image_width), max(1, window.image_height)
    return client.view.camera.shows(point, width, height, part)
