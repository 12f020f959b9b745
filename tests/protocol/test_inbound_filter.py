"""What a browser may send, over a real connection to a running server."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable
from typing import Any

import msgspec.msgpack
import numpy as np
import pytest
import viser
from camera_reports import move
from lower_limit import lower
from patience import patience
from protocol_client import CAMERA, ROW_PATCH, ProtocolClient
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from sambot_viz import Visualizer, limits
from sambot_viz.server.connections import client_writer, connection
from sambot_viz.session.clients.client_camera import ClientCamera

Connect = Callable[..., ProtocolClient]
SLIDER = "joints", "drivewhl_l_joint"
COUNT = "displays", "Grid", "Plane Cell Count"
OPTIONS = "displays", "Global Options"
FRAME, COLOR = (*OPTIONS, "Fixed Frame"), (*OPTIONS, "Background Color")
STYLE = "displays", "Grid", "Line Style"
STATUS = "displays", "Global Status"


@pytest.fixture
def witness(viz: Visualizer, protocol: Connect) -> ProtocolClient:
    """A browser that only looks."""
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    return client


def upload(client: ProtocolClient, uuid: str, content: bytes, parts: int = 1) -> None:
    client.send(
        "FileTransferStartUpload",
        source_component_uuid=uuid,
        transfer_uuid="t",
        filename="f",
        mime_type="x/y",
        part_count=parts,
        size_bytes=len(content),
    )
    client.send(
        "FileTransferPart",
        source_component_uuid=uuid,
        transfer_uuid="t",
        part_index=0,
        content=content,
    )


def still_works(viz: Visualizer, witness: ProtocolClient, protocol: Connect) -> bool:
    """Whether a late browser can move a joint and the witness sees it."""
    late = protocol(viz.viser.get_port())
    late.settle(viz.viser)
    late.edit(late.id_of(*SLIDER), 0.25)
    late.settle(viz.viser)
    witness.settle(viz.viser)
    moved = viz.joint_positions[SLIDER[1]] == 0.25
    return moved and witness.shown(*SLIDER) == 0.25


@pytest.mark.parametrize(
    ("names", "value"),
    [(COUNT, 1e300), (COUNT, 2**64 - 1), (SLIDER, 12345.0), (FRAME, "no such")],
)
def test_a_browser_without_a_camera_changes_nothing(
    viz: Visualizer,
    witness: ProtocolClient,
    protocol: Connect,
    names: tuple[str, ...],
    value: object,
) -> None:
    before = witness.shown(*names)
    stranger = protocol(viz.viser.get_port(), camera=False)
    stranger.edit(witness.id_of(*names), value)
    stranger.send_camera()
    stranger.settle(viz.viser)
    witness.settle(viz.viser)
    assert witness.shown(*names) == before
    assert still_works(viz, witness, protocol)


@pytest.mark.parametrize(
    ("names", "value"),
    [
        (COUNT, 1e300),
        (COUNT, math.nan),
        (COUNT, 2**63),
        (COUNT, True),
        (COUNT, [10]),
        (SLIDER, math.inf),
        (SLIDER, "0.5"),
        (SLIDER, {"a": [1]}),
        (SLIDER, None),
        (FRAME, 3),
        (FRAME, "x" * 1001),
        (FRAME, "a\x00b"),
        (COLOR, [1, 2]),
        (COLOR, [1, 2, "3"]),
        (COLOR, "no colour"),
        (STYLE, "Dotted"),
        (OPTIONS, 1),
        (STATUS, "Ok"),
    ],
)
def test_a_value_of_another_type_changes_no_row_and_is_answered(
    viz: Visualizer,
    witness: ProtocolClient,
    protocol: Connect,
    names: tuple[str, ...],
    value: object,
) -> None:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    # That there is another one has arrived.
    witness.settle(viz.viser)
    before, mark = witness.shown(*names), witness.mark()
    row, own = client.id_of(*names), client.mark()
    client.edit(row, value)
    client.settle(viz.viser)
    witness.settle(viz.viser)
    assert witness.since(mark) == []
    (answer,) = client.since(own)
    assert answer.type == ROW_PATCH
    assert client.row("notice")["value"]["row"] == row
    assert client.shown(*names) == before


@pytest.mark.parametrize("camera", [True, False])
def test_an_upload_does_nothing(
    viz: Visualizer, witness: ProtocolClient, protocol: Connect, camera: bool
) -> None:
    client = protocol(viz.viser.get_port(), camera=camera)
    viz.viser.gui.add_upload_button("take")
    viz.viser.flush()
    client.wait_until(lambda: "take" in client.widgets)
    upload(client, client.uuid_of("take"), b"hello")
    upload(client, client.uuid_of("take"), b"x" * 1000, parts=2)
    client.send_camera()
    client.settle(viz.viser)
    assert client.types()["FileTransferPartAck"] == 0
    assert still_works(viz, witness, protocol)


def test_messages_about_forms_are_not_kept(
    viz: Visualizer, witness: ProtocolClient, protocol: Connect
) -> None:
    client = protocol(viz.viser.get_port())
    client.send("GuiFormDirtyMessage", uuid="a" * 1000, dirty=True)
    client.send("ShareUrlRequest")
    client.settle(viz.viser)
    late = protocol(viz.viser.get_port())
    late.settle(viz.viser)
    for browser in (witness, late):
        assert browser.types()["GuiFormDirtyMessage"] == 0
        assert browser.types()["ShareUrlUpdated"] == 0


def test_a_browser_cannot_break_the_widgets_of_its_private_session(
    protocol: Connect,
) -> None:
    with Visualizer(port=0, session="private") as viz:
        first, second = (protocol(viz.viser.get_port()) for _ in range(2))
        for client in (first, second):
            client.settle(viz.viser)
        own = [c.gui.add_text("own", "mine") for c in viz.viser.get_clients().values()]
        first.wait_until(lambda: "own" in first.widgets)
        uuid = first.uuid_of("own")
        for updates in ({"removed": True}, {"props": None}, {"content": "<b>"}):
            first.send("GuiUpdateMessage", uuid=uuid, updates=updates)
        first.set_value(uuid, "changed")
        first.settle(viz.viser)
        assert {text.value for text in own} == {"mine", "changed"}
        viz.set_joint_positions({SLIDER[1]: 0.5})
        for client in (first, second):
            client.wait_until(lambda c=client: c.shown(*SLIDER) == 0.5)


def test_an_edit_of_a_row_in_the_form_of_a_widget_s_value_is_refused(
    viz: Visualizer, witness: ProtocolClient, protocol: Connect
) -> None:
    client = protocol(viz.viser.get_port())
    client.set_value("sambot-viz", [client.id_of(*SLIDER), 0.5])
    client.settle(viz.viser)
    assert viz.joint_positions[SLIDER[1]] == 0.0
    assert still_works(viz, witness, protocol)


def test_hidden_and_disabled_widgets_take_no_value(
    viz: Visualizer, protocol: Connect
) -> None:
    seen: list[object] = []
    hidden = viz.viser.gui.add_number("hidden", 1.0, visible=False)
    disabled = viz.viser.gui.add_number("disabled", 1.0, disabled=True)
    usable = viz.viser.gui.add_number("usable", 1.0)
    for handle in (hidden, disabled, usable):

        @handle.on_update
        async def _(event: viser.GuiEvent[Any]) -> None:
            seen.append(event.target)

    client = protocol(viz.viser.get_port())
    for label in ("hidden", "disabled", "usable"):
        client.set_value(client.uuid_of(label), 2.0)
    client.settle(viz.viser)
    assert (hidden.value, disabled.value, usable.value) == (1.0, 1.0, 2.0)
    assert seen == [usable]


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xc1",
        b"\x91" * 60_000,
        msgspec.msgpack.encode({"type": "NoSuchMessage"}),
        msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": 1, "updates": 2}),
        msgspec.msgpack.encode({"type": "ViewerCameraMessage", "wxyz": [1, 0]}),
        b"\x82\xa4type\xb0GuiUpdateMessage\xa4uuid\xa3\xed\xa0\x80",
        "text",
    ],
)
def test_nonsense_is_dropped_and_the_connection_stays(
    viz: Visualizer, protocol: Connect, data: bytes | str
) -> None:
    client = protocol(viz.viser.get_port())
    client.send_raw(data)
    client.settle(viz.viser)
    assert not client.closed


def test_what_is_no_camera_is_dropped(viz: Visualizer, protocol: Connect) -> None:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    for x in (math.nan, math.inf, 1e300):
        client.send("ViewerCameraMessage", **{**CAMERA, "position": (x, 0.0, 0.0)})
    for x in (0.0, 1.0, -1e6, 1e9):
        at = {"position": (x, 2.0, 1.0), "look_at": (x, 2.0, 1.0)}
        client.send("ViewerCameraMessage", **{**CAMERA, **at})
        at["look_at"] = (x + 1e-9 + abs(x) * 1e-14, 2.0, 1.0)
        client.send("ViewerCameraMessage", **{**CAMERA, **at})
    for up in (0.0, 1e-200, -1e-7):
        new = {"position": (7.0, 7.0, 7.0), "up_direction": (0.0, 0.0, up)}
        client.send("ViewerCameraMessage", **{**CAMERA, **new})
    client.settle(viz.viser)
    (handle,) = viz.viser.get_clients().values()
    assert tuple(handle.camera.position) == (3.0, 0.0, 0.0)


def test_an_error_that_a_browser_causes_is_told_to_it_alone_and_logged_once(
    viz: Visualizer,
    witness: ProtocolClient,
    protocol: Connect,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    def fail(self: object, number: int, camera: object) -> bool:
        raise ZeroDivisionError("a camera of this kind")

    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    monkeypatch.setattr(ClientCamera, "take", fail)
    for distance in range(1, 6):
        move(client, (0.0, float(distance), 0.0))
        client.settle(viz.viser)
    client.wait_until(lambda: "camera of this kind" in str(client.rows["notice"]))
    monkeypatch.undo()
    assert still_works(viz, witness, protocol)
    assert "camera of this kind" not in str(witness.rows)
    assert [record.levelname for record in caplog.records] == ["ERROR"]


def test_a_message_that_is_too_long_ends_its_connection_only(
    viz: Visualizer, witness: ProtocolClient, protocol: Connect
) -> None:
    client = protocol(viz.viser.get_port())
    client.edit(client.id_of(*FRAME), "x" * limits.PAGE_MESSAGE.value)
    with pytest.raises(AssertionError, match="the connection ended"):
        client.wait_until(lambda: False)
    assert still_works(viz, witness, protocol)


def test_a_flood_of_bad_values_is_one_line_in_the_log(
    viz: Visualizer, protocol: Connect, caplog: pytest.LogCaptureFixture
) -> None:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    caplog.clear()
    with caplog.at_level(logging.DEBUG, "asyncio"):
        for _ in range(300):
            client.edit(client.id_of(*SLIDER), "fast")
            client.send_edit(["no edit"])
        client.settle(viz.viser)
    assert len(caplog.records) <= 1
    assert all("dropped" in record.getMessage() for record in caplog.records)


def test_a_script_s_button_is_pressed_but_never_held_and_its_commands_have_no_keys(
    viz: Visualizer, protocol: Connect
) -> None:
    calls: list[str] = []
    button = viz.viser.gui.add_button("Go")
    command = viz.viser.gui.add_command("Stop")
    button.on_click(lambda _: calls.append("pressed"))
    button.on_hold(lambda _: calls.append("held"), callback_hz=10.0)
    command.on_trigger(lambda _: calls.append("command"))
    client = protocol(viz.viser.get_port())
    uuid = client.uuid_of("Go")
    client.send("GuiButtonHoldMessage", uuid=uuid, frequency=10.0)
    client.send("CommandTriggerMessage", uuid=client.uuid_of("Stop"))
    client.set_value(uuid, True)
    client.wait_until(lambda: "pressed" in calls)
    client.settle(viz.viser)
    assert calls == ["pressed"]


def test_a_picture_that_was_not_asked_for_is_dropped(
    viz: Visualizer, protocol: Connect
) -> None:
    client = protocol(viz.viser.get_port())
    client.send("GetRenderResponseMessage", payload=b"x", render_uuid="y")
    client.settle(viz.viser)
    assert not client.closed


def test_a_browser_that_does_not_read_is_disconnected(
    viz: Visualizer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client_writer, "STALL_PERIOD", 0.1)
    gone = threading.Event()
    viz.viser.on_client_disconnect(lambda _: gone.set())
    socket = connect(
        f"ws://127.0.0.1:{viz.viser.get_port()}",
        subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
        max_size=None,
        max_queue=1,
        compression=None,
    )
    socket.send(msgspec.msgpack.encode({"type": "ViewerCameraMessage", **CAMERA}))
    for number in range(64):
        viz.viser.scene.add_image(f"/large{number}", noise(), 1.0, 1.0, format="png")
    assert gone.wait(patience(20.0))
    with pytest.raises(ConnectionClosed):
        while True:
            socket.recv(timeout=patience(20.0))


def noise() -> np.ndarray:
    """A picture that cannot be compressed."""
    return np.random.default_rng(0).integers(0, 255, (512, 512, 3), np.uint8)


def test_a_flood_is_slowed_down_and_its_rest_keeps_nobody_waiting(
    protocol: Connect, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "BURST", 1.0)
    lower(monkeypatch, "PAGE_MESSAGES", 1)
    gone = threading.Event()
    with Visualizer(port=0) as viz:
        client = protocol(viz.viser.get_port())
        client.wait_until(lambda: bool(viz.viser.get_clients()))
        viz.viser.on_client_disconnect(lambda _: gone.set())
        # So few that the end of the connection is read behind them.
        for _ in range(12):
            client.send_camera()
        client.close()
        # At the rate of the flood that would be 24 seconds.
        assert gone.wait(patience(12.0))
