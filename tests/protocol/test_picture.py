"""Save Image: what a browser draws is not trusted."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Callable

import pytest
from PIL import Image
from protocol_client import ROW_PATCH, ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session import client_picture

REQUEST, FILE = "GetRenderRequestMessage", "FileTransferStartDownload"


@pytest.fixture
def client(viz: Visualizer, protocol: Callable[..., ProtocolClient]) -> ProtocolClient:
    client = protocol(viz.viser.get_port())
    client.settle(viz.viser)
    client.wait_until(lambda: "file/picture" in said(client))
    return client


def press_save(client: ProtocolClient) -> None:
    client.act("file/picture", 1280, 720)


def said(client: ProtocolClient) -> str:
    """All that the server has sent to the page in rows."""
    patches = (m for m in client.messages if m.type == ROW_PATCH)
    return "".join(str(patch.fields) for patch in patches)


def ask(client: ProtocolClient) -> str:
    """Press the button; the number of the request that comes."""
    mark = client.mark()
    press_save(client)
    client.wait_until(lambda: client.types(mark)[REQUEST] == 1)
    (request,) = (m for m in client.since(mark) if m.type == REQUEST)
    return request.fields["render_uuid"]


def png(width: int, height: int) -> bytes:
    file = io.BytesIO()
    Image.effect_noise((width, height), 100.0).save(file, "PNG")
    return file.getvalue()


def claims_to_be(width: int, height: int) -> bytes:
    """A small file whose header announces a picture of another size."""
    small = png(1, 1)
    header = b"IHDR" + struct.pack(">II", width, height) + small[24:29]
    return small[:12] + header + struct.pack(">I", zlib.crc32(header)) + small[33:]


def answer(client: ProtocolClient, number: str, payload: bytes) -> None:
    client.send("GetRenderResponseMessage", payload=payload, render_uuid=number)


def test_a_picture_of_the_size_that_was_asked_for_comes_as_a_file(
    client: ProtocolClient,
) -> None:
    answer(client, ask(client), png(1280, 720))
    client.wait_until(lambda: client.types()[FILE] == 1)
    (start,) = (m for m in client.messages if m.type == FILE)
    assert start.fields["filename"] == "sam_bot.png"
    assert start.fields["save_immediately"]


@pytest.mark.parametrize(
    ("payload", "reason"),
    [
        (b"nonsense", "not a picture"),
        (png(64, 64), "another size"),
        (claims_to_be(13_000, 13_000), "another size"),
        (png(1280, 720)[:50_000], "not a picture"),
    ],
)
def test_anything_else_is_refused_with_a_word_to_that_browser(
    client: ProtocolClient, payload: bytes, reason: str
) -> None:
    answer(client, ask(client), payload)
    client.wait_until(lambda: reason in said(client))
    assert client.types()[FILE] == 0


def test_a_browser_is_asked_for_one_picture_at_a_time(
    viz: Visualizer, client: ProtocolClient
) -> None:
    number, mark = ask(client), client.mark()
    for _ in range(20):
        press_save(client)
    client.settle(viz.viser)
    assert client.types(mark)[REQUEST] == 0
    answer(client, number, png(1280, 720))
    client.wait_until(lambda: client.types()[FILE] == 1)
    ask(client)


def test_a_browser_that_does_not_answer_can_ask_again_and_keeps_no_thread(
    client: ProtocolClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client_picture, "RENDER_TIME", 0.05)
    for count in (1, 2):
        ask(client)
        client.wait_until(
            lambda count=count: said(client).count("within 0.05 s") == count
        )
