"""The private names of viser that we use are where we use them."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import viser
from PIL import Image
from protocol_client import decode_frame

from sambot_viz import viser_private
from sambot_viz.options import Options
from sambot_viz.server.listener import listen


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    with listen(Options()) as listener:
        yield listener.viser


def test_widgets_are_found_by_their_id(server: viser.ViserServer) -> None:
    number = server.gui.add_number("number", 1.0)
    (uuid,) = server.gui._gui_input_handle_from_uuid
    assert viser_private.input_handle(server, 0, uuid) is number
    assert viser_private.input_handle(server, 0, "other") is None


def test_nodes_are_counted(server: viser.ViserServer) -> None:
    before = viser_private.node_count(server.scene)
    server.scene.add_frame("/a")
    assert viser_private.node_count(server.scene) == before + 1


def test_what_a_page_receives_is_counted_in_bytes(server: viser.ViserServer) -> None:
    before = viser_private.scene_bytes(server.scene)
    server.scene.add_glb("/glb", bytes(3000))
    corners = np.zeros((400, 3), np.float32)
    server.scene.add_mesh_simple("/mesh", corners, np.zeros((200, 3), np.uint32))
    added = viser_private.scene_bytes(server.scene) - before
    assert 3000 + 4800 + 2400 <= added < 12000


def test_the_background_is_one_pixel_of_a_colour(server: viser.ViserServer) -> None:
    viser_private.fill_background(server.scene, (48, 255, 0))
    *_, message = viser_private.broadcast_buffer(server).message_from_id.values()
    ours: Any = message
    assert (ours.format, ours.depth_data) == ("png", None)
    with Image.open(io.BytesIO(ours.rgb_data)) as picture:
        assert (picture.size, picture.mode) == ((1, 1), "RGB")
        assert picture.getpixel((0, 0)) == (48, 255, 0)
    server.scene.set_background_image(np.array([[[48, 255, 0]]], np.uint8), "png")
    *_, message = viser_private.broadcast_buffer(server).message_from_id.values()
    theirs: Any = message
    assert ours.redundancy_key() == theirs.redundancy_key()


def test_what_goes_to_all_browsers_is_in_one_buffer_with_a_loop_of_its_own(
    server: viser.ViserServer,
) -> None:
    buffer = viser_private.broadcast_buffer(server)
    before = buffer.message_counter
    server.scene.add_frame("/a")
    assert buffer.message_counter > before
    assert set(buffer.message_from_id) <= set(range(buffer.message_counter))
    for name in ("_window_loop", "max_window_size", "generator_cursors"):
        assert hasattr(buffer, name), name


def test_the_end_of_a_change_and_a_flush_can_be_replaced(
    server: viser.ViserServer,
) -> None:
    buffer, calls = viser_private.broadcast_buffer(server), list[str]()
    viser_private.replace_flush(
        buffer, lambda: calls.append("end"), lambda: calls.append("flush")
    )
    with server.atomic(), server.atomic():
        assert buffer.atomic_counter == 2
    server.flush()
    assert calls == ["end", "flush"]
    assert buffer.atomic_counter == 0


def test_messages_are_packed_as_for_a_browser_also_after_one_that_cannot_be(
    server: viser.ViserServer,
) -> None:
    server.scene.add_frame("/a")
    good = list(viser_private.broadcast_buffer(server).message_from_id.values())[-1]
    server.scene.add_frame("/b")
    bad = list(viser_private.broadcast_buffer(server).message_from_id.values())[-1]
    bad.name = object()
    packer = viser_private.Packer()
    with pytest.raises(TypeError):
        packer.pack([bad])
    for _ in range(2):
        (frame,) = decode_frame(packer.pack([good]))
        assert frame.type == type(good).__name__
        assert frame.fields["name"] == "/a"


def test_starting_and_stopping_prints_nothing(
    capfd: pytest.CaptureFixture[str],
) -> None:
    listen(Options()).close()
    out, err = capfd.readouterr()
    assert (out, err) == ("", "")


def test_a_node_that_went_with_its_parent_is_known_to_be_removed(
    server: viser.ViserServer,
) -> None:
    parent = server.scene.add_frame("/a", show_axes=False)
    child = server.scene.add_frame("/a/b", show_axes=False)
    assert not viser_private.is_removed(child)
    parent.remove()
    assert viser_private.is_removed(child)


def test_the_types_of_a_kind_of_node_are_found_out_once(
    server: viser.ViserServer,
) -> None:
    first, second = server.scene.add_frame("/a"), server.scene.add_frame("/b")
    assert "axes_length" in first._prop_hints
    assert first._prop_hints is second._prop_hints
    assert first._prop_hints is not server.scene.add_label("/c", "c")._prop_hints


def test_a_pose_is_set_as_by_visers_own_setters(server: viser.ViserServer) -> None:
    node = server.scene.add_frame("/a")
    viser_private.set_pose(node, (0.0, 1.0, 0.0, 0.0), None)
    assert (tuple(node.wxyz), tuple(node.position)) == ((0, 1, 0, 0), (0, 0, 0))
    viser_private.set_pose(node, None, (1.0, 2.0, 3.0))
    assert (tuple(node.wxyz), tuple(node.position)) == ((0, 1, 0, 0), (1, 2, 3))


def test_a_node_that_is_made_again_before_its_removal_went_out_tells_its_pose(
    server: viser.ViserServer,
) -> None:
    buffer = viser_private.broadcast_buffer(server)
    server.scene.add_frame("/a", position=(1.0, 0.0, 0.0)).remove()
    before = buffer.message_counter
    server.scene.add_frame("/a")
    newer = [one for n, one in buffer.message_from_id.items() if n >= before]
    told = {type(one).__name__: one for one in newer}
    assert told["SetPositionMessage"].position == (0.0, 0.0, 0.0)
    assert told["SetOrientationMessage"].wxyz == (1.0, 0.0, 0.0, 0.0)


def test_what_is_drawn_can_be_recorded_without_a_server() -> None:
    recorder = viser_private.Recorder(720)
    heard: list[str] = []
    recorder.listen(lambda message, arrays: heard.append(message["type"]))
    frame = recorder.scene.add_frame("/a", show_axes=False)
    frame.wxyz = (0.0, 1.0, 0.0, 0.0)
    recorder.camera.position = (1.0, 2.0, 3.0)
    recorder.scene.add_frame("/a", show_axes=False).remove()
    assert heard[-1] == "RemoveSceneNodeMessage"
    assert {"FrameMessage", "SetOrientationMessage"} <= set(heard)
    assert "SetCameraPositionMessage" in heard
    assert len(recorder.bytes()) > 100


def test_a_node_keeps_the_arrays_that_it_shares(server: viser.ViserServer) -> None:
    vertices = np.zeros((3, 3), np.float32)
    faces = np.array([[0, 1, 2]], np.uint32)
    meshes = [server.scene.add_mesh_simple(f"/{i}", vertices, faces) for i in (1, 2)]
    assert meshes[0].vertices is not vertices, "viser copies no arrays any more"
    for mesh in meshes:
        viser_private.share_arrays(mesh, vertices=vertices, faces=faces)
        assert mesh.vertices is vertices and mesh.faces is faces
    buffer = viser_private.broadcast_buffer(server)
    sent = [m for m in buffer.message_from_id.values() if hasattr(m, "props")]
    assert all(m.props.vertices is vertices for m in sent[-2:])


def test_a_file_is_sent_as_it_is_and_kept(server: viser.ViserServer) -> None:
    node = server.scene.add_glb("/file", b"glTF")
    for content in (b"other", np.arange(100_000, dtype=np.uint8)):
        viser_private.send_file(node, content)
        assert node.glb_data is content
        buffer = viser_private.broadcast_buffer(server)
        (last,) = list(buffer.message_from_id.values())[-1:]
        assert last.updates["glb_data"] is content
    # What comes later takes the place of what was there.
    sent = [m for m in buffer.message_from_id.values() if hasattr(m, "updates")]
    assert len(sent) == 1


@pytest.mark.parametrize("value", [0.0, 1e-5, -0.3, 1.0, 700.0])
def test_a_pose_is_the_same_as_the_last_one_where_numpy_finds_it_close(
    server: viser.ViserServer, value: float
) -> None:
    node, buffer = server.scene.add_frame("/a"), viser_private.broadcast_buffer(server)
    limit = 1e-8 + 1e-5 * abs(value)
    for change in (0.0, 0.9 * limit, -0.9 * limit, 1.1 * limit, -1.1 * limit):
        viser_private.set_pose(node, None, (value, value, value))
        before = buffer.message_counter
        node.position = (value, value + change, value)
        is_same = np.allclose(value + change, value)
        assert buffer.message_counter - before == (0 if is_same else 1)
        assert node.position[1] == (value if is_same else value + change)
    with pytest.raises(ValueError, match="length"):
        node.position = (1.0, 2.0)  # pyright: ignore[reportAttributeAccessIssue]


def test_a_node_is_made_without_numpy_comparing_its_pose(
    server: viser.ViserServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(np, "allclose")
    turned = (0.0, 1.0, 0.0, 0.0)
    node = server.scene.add_frame("/a", wxyz=turned, position=(1.0, 2.0, 3.0))
    assert node.wxyz.tolist() == list(turned)
    assert node.position.tolist() == [1.0, 2.0, 3.0]
