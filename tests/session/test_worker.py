"""The thread of a session, and that the event loop never waits for it."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Iterator
from functools import partial
from typing import Literal

import numpy as np
import pytest
import viser
from hand_clock import HandClock
from inside import session_of
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session.worker import Throttle, Worker

JOINT = "drivewhl_l_joint"


@pytest.fixture
def clock() -> HandClock:
    return HandClock()


@pytest.fixture
def worker(clock: HandClock) -> Iterator[Worker]:
    loop = asyncio.new_event_loop()
    worker = Worker(loop, clock)
    yield worker
    worker.close()
    loop.close()


def run_all(worker: Worker, client: int | None = None) -> None:
    """Wait for everything of a client."""
    done = threading.Event()
    worker.post(done.set, client=client)
    assert done.wait(patience(10.0))


def test_actions_run_in_the_order_in_which_they_were_posted(worker: Worker) -> None:
    ran: list[int] = []
    for number in range(100):
        worker.post(lambda n=number: ran.append(n))
    run_all(worker)
    assert ran == list(range(100))


def test_of_values_for_one_row_the_latest_wins(worker: Worker) -> None:
    ran: list[str] = []
    slider, other = ("a slider", None), ("another", None)
    posted = (("a", slider), ("b", slider), ("c", other), ("d", ("a slider", None)))
    with worker.lock:
        # The first one is taken out, and waits for the lock.
        worker.post(lambda: ran.append("first"))
        for name, of in posted:
            worker.post(lambda n=name: ran.append(n), latest_of=of)
        # What is done now may need what was set before.
        worker.post(lambda: ran.append("save"))
        worker.post(lambda: ran.append("e"), latest_of=slider)
        worker.post(lambda: ran.append("f"), latest_of=slider, client=7)
    run_all(worker)
    assert [name for name in ran if name != "f"] == ["first", "c", "d", "save", "e"]
    assert "f" in ran


def test_an_action_that_fails_is_reported_and_the_next_one_runs(worker: Worker) -> None:
    met: list[Exception] = []
    worker.on_error = lambda error, client: met.append(error)
    worker.post(lambda: 1 / 0)
    run_all(worker)
    assert [type(error) for error in met] == [ZeroDivisionError]


def test_clients_take_turns_and_each_keeps_its_order(worker: Worker) -> None:
    ran: list[tuple[int | None, int]] = []
    with worker.lock:
        post = partial(post_many, worker, ran)
        # The first action may have been taken out already: it waits for the lock.
        post(None, 1)
        post(1, 5)
        post(2, 2)
        post(3, 1)
    run_all(worker, 1)
    clients = [client for client, _ in ran[1:]]
    assert clients == [1, 2, 3, 1, 2, 1, 1, 1]
    for client in (1, 2, 3):
        numbers = [number for one, number in ran if one == client]
        assert numbers == sorted(numbers)


def test_every_other_action_is_of_one_in_control(worker: Worker) -> None:
    ran: list[tuple[int | None, int]] = []
    worker.in_control = lambda client: client < 10
    with worker.lock:
        post = partial(post_many, worker, ran)
        post(None, 1)
        for viewer in (10, 11, 12):
            post(viewer, 2)
        post(1, 2)
        post(2, 1)
    run_all(worker, 12)
    assert [client for client, _ in ran[1:]] == [10, 1, 11, 2, 12, 1, 10, 11, 12]


def post_many(
    worker: Worker, ran: list[tuple[int | None, int]], client: int | None, count: int
) -> None:
    for number in range(count):
        action = partial(ran.append, (client, number))
        worker.post(action, client=client)


def test_what_is_due_all_the_time_takes_turns_with_clients(worker: Worker) -> None:
    ran: list[str] = []
    done = threading.Event()

    def draw() -> None:
        ran.append("draws")
        if len(ran) < 200:
            worker.post_later(0.0, draw)
        else:
            done.set()

    with worker.lock:
        for _ in range(3):
            worker.post_later(0.0, draw)
        for client in (1, 2):
            worker.post(partial(ran.append, f"joins {client}"), client=client)
    assert done.wait(patience(10.0))
    assert ran.index("joins 1") <= 2
    assert ran.index("joins 2") <= 4


def test_an_error_is_reported_with_the_client_that_has_caused_it(
    worker: Worker,
) -> None:
    met: list[tuple[type[Exception], int | None]] = []
    worker.on_error = lambda error, client: met.append((type(error), client))
    worker.post(lambda: 1 / 0, client=7)
    worker.post(lambda: 1 / 0)
    worker.post(lambda: worker.report(KeyError()), client=8)
    for client in (7, 8, None):
        run_all(worker, client)
    worker.report(ValueError())
    errors = {(ZeroDivisionError, 7), (ZeroDivisionError, None), (KeyError, 8)}
    assert set(met[:-1]) == errors
    assert met[-1] == (ValueError, None)


def test_a_later_action_runs_after_its_delay(worker: Worker, clock: HandClock) -> None:
    ran: list[str] = []
    worker.post_later(0.05, lambda: ran.append("late"))
    worker.post_later(0.02, lambda: ran.append("sooner"))
    worker.post(lambda: ran.append("now"))
    run_all(worker)
    assert ran == ["now"]
    for seconds, expected in ((0.01, 1), (0.02, 2), (0.01, 2), (0.02, 3)):
        clock.advance(seconds)
        run_all(worker)
        assert ran == ["now", "sooner", "late"][:expected]


def test_a_worker_that_waits_wakes_for_a_later_action(
    worker: Worker, clock: HandClock
) -> None:
    done = threading.Event()
    worker.post_later(60.0, done.set)
    clock.advance(60.0)
    assert done.wait(patience(10.0))


def test_a_stream_of_requests_runs_at_a_steady_rate(
    worker: Worker, clock: HandClock
) -> None:
    ran: list[float] = []
    throttle = Throttle(worker, 0.1, lambda: ran.append(clock.now()))
    for _ in range(100):
        throttle.request()
        clock.advance(0.01)
        run_all(worker)
    assert np.diff(ran) == pytest.approx(0.1, abs=0.011)
    assert len(ran) == 10


def test_a_throttle_runs_at_once_after_a_pause_and_nothing_that_was_not_requested(
    worker: Worker, clock: HandClock
) -> None:
    ran: list[float] = []
    throttle = Throttle(worker, 0.1, lambda: ran.append(clock.now()))
    throttle.request()
    assert len(ran) == 1
    clock.advance(5.0)
    run_all(worker)
    assert len(ran) == 1
    throttle.request()
    throttle.request()
    assert len(ran) == 2
    throttle.close()
    clock.advance(5.0)
    run_all(worker)
    throttle.request()
    assert len(ran) == 2


def test_closing_never_waits_for_the_lock_of_the_caller(worker: Worker) -> None:
    with worker.lock:
        worker.post(lambda: None)
        worker.close()
    assert not worker.is_alive()


def test_an_action_may_close_its_own_worker(worker: Worker) -> None:
    worker.post(worker.close)
    worker.join(patience(10.0))
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
            assert answered.wait(patience(10.0))
        client.settle(viz.viser)
