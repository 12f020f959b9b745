"""What is inside a Visualizer and that its public names do not give to tests."""

from __future__ import annotations

from typing import Any

import viser

from sambot_viz import Visualizer
from sambot_viz.panels.files_panel import Files
from sambot_viz.session import Session
from sambot_viz.session.signals import Signal


def viser_server(viz: Visualizer) -> viser.ViserServer:
    """The viser server, for `ProtocolClient.settle`."""
    return viz._server._viser  # pyright: ignore[reportPrivateUsage]


def node_of(viz: Visualizer, frame: str) -> str:
    """The name of the scene node of a TF frame, in a shared session."""
    session = viz._server.sessions.shared  # pyright: ignore[reportPrivateUsage]
    path = None if session is None else session.scene.context.nodes.path(frame)
    if path is None:
        raise AssertionError(f"no node for frame '{frame}'")
    return path


def session_of(viz: Visualizer) -> Session:
    """The session of all browsers, or of the one that came first; the test looks."""
    session = session_alone_of(viz)
    if session.data is not None:
        with session.lock:
            session.data.look("test")
    return session


def session_alone_of(viz: Visualizer) -> Session:
    """The same, while nobody looks at it."""
    return viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]


def is_signal(value: object) -> bool:
    return isinstance(value, Signal)


def signals_of(session: Session) -> list[Signal[Any]]:
    """Everything that a session tells."""
    parts = (
        session.document,
        session.scene,
        session.robot,
        session.problems,
        session.checks,
    )
    return [one for part in parts for one in vars(part).values() if is_signal(one)]


def all_have_rows(viz: Visualizer) -> bool:
    """Whether the panels of each client are there, which is after viser has it."""
    rows_of = viz._server.clients.rows_of  # pyright: ignore[reportPrivateUsage]
    return all(map(rows_of, viz.viser.get_clients()))


def files_of(viz: Visualizer) -> Files:
    """The disk, as the shared session's browsers use it."""
    return viz._configs  # pyright: ignore[reportPrivateUsage]
