"""Callbacks of a program: called when something has changed in a session."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from sambot_viz.outlet import logger
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

Moved = Callable[[Mapping[str, float]], object]
"""Takes joint → position [rad or m]."""

_log = logger("sambot_viz")


def tell_moves(session: Session, callback: Moved) -> None:
    """Call a function whenever joints of a session have moved; log its errors."""
    told: dict[str, float] = {}

    def moved() -> None:
        joints = session.robot.joints
        now = {} if joints is None else joints.all_positions()
        if now == told:
            return
        told.clear()
        told.update(now)
        try:
            callback(MappingProxyType(now))
        except Exception:
            _log.exception("error in a callback of on_joint_positions")

    with session.lock:
        if session.robot.joints is not None:
            told.update(session.robot.joints.all_positions())
        connect([session.robot.positions], moved)
