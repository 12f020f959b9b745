"""Poses that move reach every page, whatever else happens to their nodes meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from random import Random

import pytest
import viser
from pose_tracks import PoseTracks
from protocol_client import ProtocolClient, Received

from sambot_viz import viser_private
from sambot_viz.options import Options
from sambot_viz.server.listener import listen
from sambot_viz.server.outgoing import outbox

Connect = Callable[..., ProtocolClient]
Pose = tuple[tuple[float, ...], tuple[float, ...]]
AT_FIRST: Pose = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
NAMES = ("/a", "/b", "/a/c", "/a/d", "/b/e")


@pytest.fixture
def server() -> Iterator[viser.ViserServer]:
    with listen(Options(port=0)) as listener:
        yield listener.viser


def seen(messages: list[Received]) -> dict[str, Pose]:
    """The nodes of a page that got these messages, and where they are."""
    poses: dict[str, Pose] = {}
    for message in messages:
        name = message.fields.get("name", "")
        match message.type:
            case "FrameMessage":
                # viser keeps the pose of a node that is made again.
                poses.setdefault(name, AT_FIRST)
            case "RemoveSceneNodeMessage":
                for gone in [n for n in poses if f"{n}/".startswith(f"{name}/")]:
                    del poses[gone]
            case "SetOrientationMessage" if name in poses:
                poses[name] = (tuple(message.fields["wxyz"]), poses[name][1])
            case "SetPositionMessage" if name in poses:
                poses[name] = (poses[name][0], tuple(message.fields["position"]))
            case _:
                pass
    return {name: pose for name, pose in poses.items() if name in NAMES}


def kept(server: viser.ViserServer) -> dict[str, Pose]:
    """The same of who reads viser's buffer, such as its recordings."""
    buffer = viser_private.broadcast_buffer(server)
    found: list[Received] = []
    for message in buffer.message_from_id.values():
        if message.include_in_scene_serialization:
            fields = message.as_serializable_dict([])
            found.append(Received(fields.pop("type"), fields, 0, 0, 0, 0.0))
    return seen(found)


class Anything:
    """Does what may happen to nodes, at random."""

    def __init__(self, scene: viser.SceneApi, seed: int) -> None:
        self._scene = scene
        self._random = Random(seed)
        self.nodes: dict[str, viser.FrameHandle] = {}

    def happen(self) -> None:
        act = self._random.choice((self._make, *[self._move] * 6, self._remove))
        act(self._random.choice(NAMES))

    def poses(self) -> dict[str, Pose]:
        """Where the nodes are that there are."""
        there = {
            name: node
            for name, node in self.nodes.items()
            if not viser_private.is_removed(node)
        }
        return {
            name: (tuple(node.wxyz.tolist()), tuple(node.position.tolist()))
            for name, node in there.items()
        }

    def _there(self, name: str) -> bool:
        node = self.nodes.get(name)
        return node is not None and not viser_private.is_removed(node)

    def _make(self, name: str) -> None:
        above = name.rpartition("/")[0]
        if not above or self._there(above):
            self.nodes[name] = self._scene.add_frame(name, show_axes=False)

    def _remove(self, name: str) -> None:
        if self._there(name):
            self.nodes[name].remove()

    def _move(self, name: str) -> None:
        if not self._there(name):
            return
        wxyz = self._random.choice([(0.6, 0.8, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)])
        position = (self._random.random(), 1e7 / 3.0, 0.0)
        match self._random.randrange(4):
            case 0:
                viser_private.set_pose(self.nodes[name], wxyz, None)
            case 1:
                viser_private.set_pose(self.nodes[name], None, position)
            case 2:
                viser_private.set_pose(self.nodes[name], wxyz, position)
            case _:
                # A program does so.
                self.nodes[name].position = position


@pytest.mark.parametrize("seed", range(8))
def test_every_page_has_the_scene_whatever_happens(
    server: viser.ViserServer, protocol: Connect, seed: int
) -> None:
    random, anything = Random(seed), Anything(server.scene, seed)
    pages = [protocol(server.get_port())]
    for _ in range(12):
        for _ in range(random.randrange(4)):
            with server.atomic():
                for _ in range(random.randrange(8)):
                    anything.happen()
        anything.happen()
        if random.random() < 0.3:
            # One comes, or comes back.
            pages.append(protocol(server.get_port()))
        if random.random() < 0.5:
            for page in pages:
                page.settle(server)
                assert seen(page.messages) == anything.poses()
    pages.append(protocol(server.get_port()))
    for page in pages:
        page.settle(server)
        assert seen(page.messages) == anything.poses()
    assert kept(server) == anything.poses()


def test_a_page_that_is_behind_gets_no_pose_that_a_program_has_replaced(
    server: viser.ViserServer,
) -> None:
    buffer = viser_private.broadcast_buffer(server)
    nodes = [server.scene.add_frame(name, show_axes=False) for name in ("/a", "/b")]
    page = PoseTracks()
    for node in nodes:
        viser_private.set_pose(node, None, (1.0, 0.0, 0.0))
        *_, told = buffer.message_from_id.values()
        fields = told.as_serializable_dict([])
        page.unpacked(fields.pop("type"), fields)
        viser_private.set_pose(node, None, (2.0, 0.0, 0.0))
    # It has heard what the numbers are, and nothing since.
    nodes[0].position = (3.0, 0.0, 0.0)
    moved = viser_private.MovingPoses.of(buffer).between(-1, buffer.message_counter)
    (only,) = page.unpacked("SetPositionMessage", vars(moved))
    assert (only["name"], only["position"]) == ("/b", [2.0, 0.0, 0.0])


def test_each_step_reaches_a_page_that_has_the_one_before(
    server: viser.ViserServer, protocol: Connect
) -> None:
    nodes = [server.scene.add_frame(name, show_axes=False) for name in ("/a", "/b")]
    page = protocol(server.get_port())
    for step in range(6):
        place = (float(step), 0.0, 0.0)
        viser_private.set_pose(nodes[step % 2], None, place)
        server.flush()
        page.wait_until(
            lambda name=nodes[step % 2].name, at=place: (
                seen(page.messages)[name][1] == at
            )
        )


def test_the_scene_of_one_client_moves_in_the_same_way(
    server: viser.ViserServer, protocol: Connect
) -> None:
    page = protocol(server.get_port())
    page.settle(server)
    (client,) = server.get_clients().values()
    outbox.prepare_own(server, client.client_id)
    anything = Anything(client.scene, 1)
    for _ in range(30):
        with client.atomic():
            for _ in range(5):
                anything.happen()
        if not anything.nodes:
            continue
        page.settle(server)
        assert seen(page.messages) == anything.poses()
