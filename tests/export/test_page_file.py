"""Pages for browsers are made one at a time, and nobody waits for them."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine
from typing import Any

import pytest
from inside import session_of
from lower_limit import lower
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.errors import SambotVizError
from sambot_viz.export import page_file as pages
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client


def ask(session: Session, client: Client, motion: str) -> Coroutine[Any, Any, bytes]:
    past = session.robot.recorder.last_minute()
    return pages.ask_page(session.copy(), past, client, motion)()


def test_while_a_page_is_made_the_loop_and_the_session_are_free(
    monkeypatch: pytest.MonkeyPatch, protocol: Callable[..., ProtocolClient]
) -> None:
    running, most, go_on = [0], [0], threading.Event()
    begun = threading.Event()

    def slow(*arguments: Any) -> bytes:
        running[0] += 1
        most[0] = max(most[0], running[0])
        begun.set()
        assert go_on.wait(patience(20.0))
        running[0] -= 1
        return b"page"

    monkeypatch.setattr(pages, "page_file", slow)
    with Visualizer(port=0) as viz:
        session, loop = session_of(viz), viz.viser.get_event_loop()
        for _ in range(2):
            protocol(viz.viser.get_port()).settle(viz.viser)
        browsers = list(session.clients.all.values())
        assert len(browsers) == 2
        asked = [
            asyncio.run_coroutine_threadsafe(ask(session, browser, "sweep"), loop)
            for browser in browsers
        ]
        assert begun.wait(patience(10.0))

        async def answer() -> str:
            return "free"

        assert asyncio.run_coroutine_threadsafe(answer(), loop).result(5.0) == "free"
        assert session.lock.acquire(timeout=patience(5.0))
        session.lock.release()
        viz.set_joint_positions({"drivewhl_l_joint": 1.0})
        go_on.set()
        assert [page.result(10.0) for page in asked] == [b"page", b"page"]
    assert most == [1]


def test_a_page_that_is_too_large_is_not_sent(
    monkeypatch: pytest.MonkeyPatch, protocol: Callable[..., ProtocolClient]
) -> None:
    lower(monkeypatch, "EXPORTED_PAGE", 1000)
    with Visualizer(port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        session = session_of(viz)
        (browser,) = session.clients.all.values()
        made = asyncio.run_coroutine_threadsafe(
            ask(session, browser, "none"), viz.viser.get_event_loop()
        )
        with pytest.raises(SambotVizError, match="the page would have 1 MB"):
            made.result(20.0)
