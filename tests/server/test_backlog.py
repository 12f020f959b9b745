"""A browser that sends faster than its session works."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
import viser
from protocol_client import ProtocolClient

from sambot_viz.options import Options
from sambot_viz.server import door
from sambot_viz.server.backlog import WINDOW
from sambot_viz.server.bind import close, listen


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = listen(Options())
    yield server
    close(server)


def test_what_a_session_has_not_done_yet_waits_in_the_connection(
    server: viser.ViserServer, protocol: Callable[..., ProtocolClient]
) -> None:
    taken: list[object] = []
    waiting: list[Callable[[], None]] = []
    door.give_edits(
        server,
        door.Edits(
            take=lambda _, edit: taken.append(edit),
            may=lambda _: True,
            behind=lambda _, done: waiting.append(done),
        ),
    )
    client = protocol(server.get_port())
    last = 5 * WINDOW
    for number in range(last):
        client.edit("row", number)
    done = 0
    while len(taken) < last:
        seen = len(taken)
        assert seen < (done + 2) * WINDOW
        if waiting:
            waiting.pop(0)()
            done += 1
        client.wait_until(lambda: bool(waiting) or len(taken) > seen)  # noqa: B023
    assert taken == [["row", number] for number in range(last)]
