"""The tree as DOT, JSON and SVG, and the layout of the picture."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from itertools import pairwise

import numpy as np
import pytest

from sambot_viz.frames import FrameHistory, FrameTree, Transform
from sambot_viz.frames.export.drawing import tree_dot, tree_json, tree_json_text
from sambot_viz.frames.export.svg import tidy_tree, tree_svg
from sambot_viz.frames.robot_frames import robot_frames
from sambot_viz.robot.model import Robot

SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture
def tree(robot: Robot) -> FrameTree:
    """The robot's frames, a laser, and names that need care."""
    tree = robot_frames(robot)
    tree.set_static("base_link", "base_laser", Transform.from_xyz_rpy((0.1, 0, 0.2)))
    tree.set_static('a "quoted" <name>\\', "센서\x01", Transform.identity())
    return tree


def test_json_has_every_transform_with_its_joint(tree: FrameTree, robot: Robot) -> None:
    drawn = tree_json(tree, robot)
    assert drawn["roots"] == ["base_link", "buoy", 'a "quoted" <name>\\']
    assert drawn["frames"] == list(tree.frames)
    edges = {edge["child"]: edge for edge in drawn["transforms"]}
    assert edges["wheel"] == {
        "parent": "base_link",
        "child": "wheel",
        "joint": "wheel_joint",
        "type": "continuous",
        "static": False,
        "rate": None,
        "xyz": [-0.12, 0.18, -0.05],
        "rpy": pytest.approx([0, 0, 1.5]),
        "rotation_xyzw": tree.hop("wheel").transform.rotation_xyzw.tolist(),
    }
    assert (edges["base_laser"]["joint"], edges["base_laser"]["static"]) == (None, True)
    assert json.loads(tree_json_text(tree, robot)) == drawn


def test_dot_has_joint_pose_and_view_frames_lines_at_the_edges(
    tree: FrameTree, robot: Robot
) -> None:
    dot = tree_dot(tree, robot)
    assert dot.startswith("digraph frames {\n")
    assert dot.endswith("}\n")
    assert (
        '  "mast" -> "lamp" [label="lamp_joint\\nfixed\\nxyz 0 0 1\\nrpy 0 0 0\\n'
        "Broadcaster: default_authority\\nAverage rate: 10000.0\\n"
        "Buffer length: 0.0\\nMost recent transform: 0.0\\n"
        'Oldest transform: 0.0"];\n'
    ) in dot
    assert (
        '  "base_link" -> "wheel" [label="wheel_joint\\ncontinuous\\n'
        "xyz -0.12 0.18 -0.05\\nrpy 0 0 1.5\\nBroadcaster: default_authority\\n"
        'Most recent transform: 0.0", color=blue];\n'
    ) in dot
    assert '  "a \\"quoted\\" <name>\\\\" -> "센서\N{REPLACEMENT CHARACTER}" [' in dot


def test_frames_that_messages_move_have_their_rate() -> None:
    history = FrameHistory()
    poses = np.array([[1.0, 0, 0, 0, 0, 0, 1]])
    # The first one is older than the ten seconds that are kept.
    for tenth in (-18_000, *range(0, 41, 2)):
        history.add(tenth * 100_000_000, (("odom", "base_link"),), poses)
    history.add(4_000_000_000, (("odom", "once"),), poses)
    tree = FrameTree(history)
    for child in ("base_link", "once"):
        tree.set("odom", child, Transform.identity(), 4.0)
    tree.set_static("base_link", "laser", Transform.identity())
    assert {edge["child"]: edge["rate"] for edge in tree_json(tree)["transforms"]} == {
        "base_link": 5.0,
        "once": None,
        "laser": None,
    }
    assert (
        '"odom" -> "base_link" [label="transform\\nxyz 0 0 0\\nrpy 0 0 0\\n'
        "Broadcaster: default_authority\\nAverage rate: 5.000\\n"
        "Buffer length: 4.000\\nMost recent transform: 4.000000\\n"
        'Oldest transform: 0.000000"'
    ) in tree_dot(tree)
    assert tree_svg(tree).count(">5.0 Hz<") == tree_svg(tree).count(" Hz<") == 1


def test_a_rate_is_that_of_all_who_publish_a_frame() -> None:
    history = FrameHistory()
    poses = np.array([[1.0, 0, 0, 0, 0, 0, 1]] * 2)
    for second in range(5):
        time = second * 1_000_000_000
        history.add(time, (("odom", "a"), ("odom", "b")), poses)
        history.add(time + 500_000_000, (("odom", "a"),), poses[:1])
    tree = FrameTree(history)
    for child in ("a", "b"):
        tree.set("odom", child, Transform.identity(), 4.0)
    rates = {edge["child"]: edge["rate"] for edge in tree_json(tree)["transforms"]}
    assert rates == {"a": 2.0, "b": 1.0}


def test_without_frames_dot_and_svg_say_so() -> None:
    assert '"No tf data received"' in tree_dot(FrameTree())
    assert "No tf data received" in tree_svg(FrameTree())


def test_svg_is_xml_with_every_frame_and_edge(tree: FrameTree, robot: Robot) -> None:
    root = ElementTree.fromstring(tree_svg(tree, robot))
    texts = [element.text for element in root.iter(f"{SVG}text")]
    for frame in ("base_link", "wheel", "lamp", 'a "quoted" <name>\\'):
        assert frame in texts
    for line in ("wheel_joint", "continuous", "xyz -0.12 0.18 -0.05", "rpy 0 0 1.5"):
        assert line in texts
    links = [path for path in root.iter(f"{SVG}path") if path.get("marker-end")]
    edges = [frame for frame in tree.frames if tree.parent(frame)]
    assert len(links) == len(edges)
    assert sum(path.get("class") == "static" for path in links) == len(edges) - 1


def test_svg_reaches_for_nothing_outside(tree: FrameTree, robot: Robot) -> None:
    svg = tree_svg(tree, robot).replace("http://www.w3.org/2000/svg", "")
    assert "http" not in svg
    assert "href" not in svg


@pytest.mark.parametrize("seed", range(10))
def test_no_two_boxes_of_one_depth_overlap_and_parents_stand_in_the_middle(
    seed: int,
) -> None:
    random = np.random.default_rng(seed)
    children: dict[str, list[str]] = {"0": [], "1": []}
    for i in range(2, 60):
        children[str(random.integers(0, i))].append(str(i))
        children[str(i)] = []
    width = {node: float(random.uniform(20, 150)) for node in children}
    places = tidy_tree(("0", "1"), children.__getitem__, width.__getitem__, gap=10)
    assert places.keys() == children.keys()
    levels: dict[int, list[tuple[float, float]]] = {}
    for node, place in places.items():
        half = width[node] / 2
        levels.setdefault(place.depth, []).append((place.x - half, place.x + half))
        if below := children[node]:
            ends = places[below[0]].x, places[below[-1]].x
            assert place.x == pytest.approx(sum(ends) / 2)
    for boxes in levels.values():
        for (_, right), (left, _) in pairwise(sorted(boxes)):
            assert left - right >= 10 - 1e-9
    assert min(left for boxes in levels.values() for left, _ in boxes) == (
        pytest.approx(0)
    )


def test_a_chain_of_over_a_thousand_frames_can_be_drawn() -> None:
    tree = FrameTree()
    for i in range(1100):
        tree.set_static(f"f{i}", f"f{i + 1}", Transform.identity())
    places = tidy_tree(tree.roots, tree.children, lambda _: 1.0, 1.0)
    assert places["f1100"].depth == 1100
