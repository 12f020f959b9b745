"""State with one lock and one audience: changed, sent and told together."""

from __future__ import annotations

from sambot_viz.session.signals import Audience, Change, Signal
from sambot_viz.session.worker import Worker


class Signals:
    """What of a session changes.

    Args:
        change: sends the changes of the session.

    Attributes:
        robot: another robot is shown, or the same after an edit.
        config: another document is shown, or what is listed in it has changed.
        frames: the frames, their parents, or the fixed frame.
        joints: the positions of joints and of frames that move.
        motion: how fast the robot drives, and what keeps turning.
        status: what displays report, and what has been read for them.
        problems: what is wrong.
        follow: whether all browsers show what the browser shows whose camera moved
            last, of those that may change the session.
    """

    def __init__(self, change: Change) -> None:
        self.robot = Signal(change, None)
        self.config = Signal(change, None)
        self.frames = Signal(change, None)
        self.joints = Signal(change, None)
        self.motion = Signal(change, None)
        self.status = Signal(change, None)
        self.problems = Signal(change, None)
        self.follow = Signal(change, False)


class SharedState:
    """Base of `Session`: the lock, the signals, and how a change is sent.

    Args:
        audience: who sees the state.
        worker: the thread that browsers, timers and files act in.

    Attributes:
        lock: the worker's; held while the state changes.
        change: changes the state; see `Change`.
        signals: what changes.
    """

    def __init__(self, audience: Audience, worker: Worker) -> None:
        self.audience = audience
        self.worker = worker
        self.lock = worker.lock
        self.change = Change(worker, audience)
        self.signals = Signals(self.change)
