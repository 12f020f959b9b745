"""The thread of a session, and that the event loop never waits for it."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from typing import Literal

import pytest
import viser
from inside import session_of
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session.worker import Worker

JOINT = "drivewhl_l_joint"


@pytest.fixture
def worker() -> Iterator[Worker]:
    loop = asyncio.new_event_loop()
    worker = Worker(loop)
    yield worker
    worker.close()
    loop.close()


def run_all(worker: Worker) -> None:
    done = threading.Event()
    worker.post(done.set)
    assert done.wait(10)


def test_actions_run_in_the_order_in_which_they_were_posted(worker: Worker) -> None:
    ran: list[int] = []
    for number in range(100):
        worker.post(lambda n=number: ran.append(n))
    run_all(worker)
    assert ran == list(range(100))


def test_of_values_in_a_row_the_latest_wins(worker: Worker) -> None:
    ran: list[str] = []
    slider, other = object(), object()
    with worker.lock:
        for name, of in (("a", slider), ("b", slider), ("c", other), ("d", slider)):
            worker.post(lambda n=name: ran.append(n), latest_of=of)
        # The first one may have been taken out already: it waits for the lock.
    run_all(worker)
    assert ran in (["b", "c", "d"], ["a", "b", "c", "d"])


def test_an_action_that_fails_is_reported_and_the_next_one_runs(worker: Worker) -> None:
    met: list[Exception] = []
    worker.on_error = met.append
    worker.post(lambda: 1 / 0)
    run_all(worker)
    assert [type(error) for error in met] == [ZeroDivisionError]


def test_a_later_action_runs_after_its_delay(worker: Worker) -> None:
    ran: list[str] = []
    done = threading.Event()
    worker.post_later(0.05, lambda: (ran.append("late"), done.set()))
    worker.post(lambda: ran.append("now"))
    assert done.wait(10)
    assert ran == ["now", "late"]


def test_closing_never_waits_for_the_lock_of_the_caller(worker: Worker) -> None:
    with worker.lock:
        worker.post(lambda: None)
        worker.close()
    assert not worker.is_alive()


def test_an_action_may_close_its_own_worker(worker: Worker) -> None:
    worker.post(worker.close)
    worker.join(10)
    assert not worker.is_alive()


def test_nothing_runs_after_closing(worker: Worker) -> None:
    ran: list[str] = []
    run_all(worker)
    worker.close()
    worker.post(lambda: ran.append("late"))
    worker.post_later(0.0, lambda: ran.append("later"))
    assert ran == []


@pytest.mark.parametrize("mode", ["shared", "private"])
def test_the_event_loop_goes_on_while_a_session_is_busy(
    protocol: Callable[..., ProtocolClient], mode: Literal["shared", "private"]
) -> None:
    with Visualizer(port=0, session=mode) as viz:
        answered = threading.Event()
        echo = viz.viser.gui.add_text("echo", "")

        @echo.on_update
        async def _(event: viser.GuiEvent[viser.GuiTextHandle]) -> None:
            answered.set()

        client = protocol(viz.viser.get_port())
        client.settle(viz.viser)
        session = session_of(viz)
        with session.lock:
            # As a reload of a large robot does for a second.
            client.edit(client.id_of("joints", JOINT), 0.5)
            client.act("joints/center")
            client.send_camera()
            client.act("tools/choose", "Measure")
            client.send(
                "ScenePointerMessage",
                event_type="click",
                ray_origin=(0.0, 0.0, 5.0),
                ray_direction=(0.0, 0.0, -1.0),
                screen_pos=((0.5, 0.5),),
                modifier=None,
            )
            protocol(viz.viser.get_port()).close()
            client.set_value(client.uuid_of("echo"), "still there")
            assert answered.wait(10)
        client.settle(viz.viser)
