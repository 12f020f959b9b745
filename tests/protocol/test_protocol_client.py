"""The recording client itself, against a bare viser server."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
import viser
from protocol_client import ProtocolClient

Connect = Callable[[int], ProtocolClient]


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    yield server
    server.stop()


def test_a_new_client_has_received_the_scene_and_the_widgets(
    server: viser.ViserServer, protocol: Connect
) -> None:
    server.scene.add_box("/box", dimensions=(1.0, 2.0, 3.0))
    server.gui.add_slider("left wheel", -1.0, 1.0, 0.01, 0.25)
    client = protocol(server.get_port())
    assert client.node("/box").fields["props"]["dimensions"] == [1.0, 2.0, 3.0]
    assert "left wheel" in client.widgets
    assert client.value_of("left wheel") == 0.25


def test_one_slider_step_is_one_message_to_each_client(
    server: viser.ViserServer, protocol: Connect
) -> None:
    box = server.scene.add_box("/box")
    slider = server.gui.add_slider("left wheel", -1.0, 1.0, 0.01, 0.0)

    @slider.on_update
    async def _(event: viser.GuiEvent[viser.GuiSliderHandle[float]]) -> None:
        box.position = (event.target.value, 0.0, 0.0)

    first, second = protocol(server.get_port()), protocol(server.get_port())
    for client in (first, second):
        client.settle(server)
    marks = first.mark(), second.mark()
    first.set_value(first.uuid_of("left wheel"), 0.5)
    first.settle(server)
    second.settle(server)
    assert [m.type for m in first.since(marks[0])] == ["SetPositionMessage"]
    assert first.messages[-1].fields["position"] == [0.5, 0.0, 0.0]
    assert first.messages[-1].size < 120
    assert second.types(marks[1]) == {"SetPositionMessage": 1, "GuiUpdateMessage": 1}
    assert second.value_of("left wheel") == 0.5


def test_the_fence_proves_that_an_idle_server_sends_nothing(
    server: viser.ViserServer, protocol: Connect
) -> None:
    client = protocol(server.get_port())
    client.settle(server)
    mark = client.mark()
    client.settle(server)
    assert client.since(mark) == []


def test_the_fence_covers_what_only_one_client_gets(
    server: viser.ViserServer, protocol: Connect
) -> None:
    private = server.gui.add_button("mine")

    @private.on_click
    async def _(event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        assert event.client is not None
        event.client.scene.add_frame("/mine")

    client, other = protocol(server.get_port()), protocol(server.get_port())
    client.set_value(client.uuid_of("mine"), True)
    client.settle(server)
    other.settle(server)
    assert client.node("/mine").type == "FrameMessage"
    assert all(m.fields.get("name") != "/mine" for m in other.messages)


def test_arrays_are_given_as_their_bytes(
    server: viser.ViserServer, protocol: Connect
) -> None:
    points = np.array([[[0, 1, 2], [3, 4, 5]]], np.float32)
    server.scene.add_line_segments("/line", points, colors=(255, 0, 0))
    client = protocol(server.get_port())
    sent = client.node("/line").fields["props"]["points"]
    assert np.frombuffer(sent, np.float32).tolist() == [0, 1, 2, 3, 4, 5]
    assert client.node("/line").size > len(sent)


def test_waiting_in_vain_says_what_was_received(
    server: viser.ViserServer, protocol: Connect
) -> None:
    client = protocol(server.get_port())
    with pytest.raises(AssertionError, match=r"0\.01 s passed.*ReplayDoneMessage"):
        client.wait_until(lambda: False, timeout=0.01)


def test_waiting_ends_when_the_server_ends(
    server: viser.ViserServer, protocol: Connect
) -> None:
    client = protocol(server.get_port())
    server.stop()
    with pytest.raises(AssertionError, match="the connection ended"):
        client.wait_until(lambda: False)
