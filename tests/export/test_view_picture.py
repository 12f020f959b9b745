"""A picture of a large scene may take longer, and one that takes too long says so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from sambot_viz.errors import ServerError
from sambot_viz.export.view_picture import LONGEST_WAIT, longest_wait, render


def client(outcome: BaseException) -> Any:
    """A page that does not draw."""

    def get_render(*_: Any, timeout: float, **__: Any) -> None:
        assert timeout == 200.0
        raise outcome

    connections = SimpleNamespace(_live_connections={})
    server = SimpleNamespace(_websock_server=connections)
    return SimpleNamespace(client_id=0, get_render=get_render, _viser_server=server)


def test_the_wait_grows_with_the_scene() -> None:
    assert longest_wait(0) == LONGEST_WAIT
    assert longest_wait(70_000_000) == LONGEST_WAIT + 140.0


def test_a_page_that_does_not_draw_in_time_is_a_sentence() -> None:
    with pytest.raises(ServerError, match=r"did not show everything within 200 s"):
        render(client(TimeoutError("no frame")), 64, 48, 200.0)


def test_another_failure_of_the_page_is_not_called_slow() -> None:
    with pytest.raises(RuntimeError, match="gone"):
        render(client(RuntimeError("gone")), 64, 48, 200.0)
