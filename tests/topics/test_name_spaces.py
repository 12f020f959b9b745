"""Robots with name spaces: their frames are kept apart, in one tree."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest
from made_recording import described, write_recording

from sambot_viz.frames import FrameTree, LookupRefused
from sambot_viz.frames.samples import FramePair
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.topics.frame_limit import Transforms
from sambot_viz.topics.name_spaces import NameSpaces, separate_spaces

Tree = Mapping[str, str]
"""Child → parent."""
ROBOT: Tree = {"odom": "map", "base_link": "odom", "arm": "base_link"}
SPACES = ("/a", "/b", "/a/b", "")
NAMES = ("map", "odom", "base_link", "arm", "a/arm", "b/arm", "b/odom", "a/b/arm", "x")


def frames_of(path: Path, at: float | None = None) -> FrameTree:
    with Inputs(Options(path, at=at)) as inputs:
        robot, recorded = inputs.robot(), inputs.moved_by
        assert recorded is not None
        return recorded.frames(robot, inputs.options.start_pose.state(robot))


@pytest.fixture
def write(tmp_path: Path) -> Callable[..., Path]:
    """Write a recording of name spaces, each with its tree, and of descriptions."""

    def write(spaces: Mapping[str, Tree], *described_in: str) -> Path:
        urdf = described("base_link", "arm")
        texts = {f"{space}/robot_description": urdf for space in described_in}
        told = [
            (f"{space}/tf", number / 10, tree)
            for number in range(10)
            for space, tree in spaces.items()
        ]
        return write_recording(tmp_path / "spaces.mcap", texts, told)

    return write


def test_two_robots_stand_in_one_map_each_with_its_joints(shared: Path) -> None:
    path = shared / "data" / "reported" / "recordings" / "two_robots_ns.mcap"
    tree = frames_of(path)
    assert {f: tree.parent(f) for f in tree.frames} == {
        "map": None,
        "a/base_link": "map",
        "a/arm": "a/base_link",
        "b/base_link": "map",
    }
    here, there = (tree.lookup("map", f"{robot}/base_link") for robot in "ab")
    assert here.translation.tolist() == [0.0, 0.0, 0.0]
    assert there.translation.tolist() == [4.0, 0.0, 0.0]


def test_frames_keep_their_names_where_one_name_space_tells_of_them(
    write: Callable[..., Path],
) -> None:
    assert set(frames_of(write({"/a": ROBOT}, "/a")).frames) == {"map", *ROBOT}
    # What a second name space publishes of the one robot that there is stays apart.
    both = write({"": ROBOT, "/a": {"x": "y"}}, "")
    assert set(frames_of(both).frames) == {"map", *ROBOT}


def test_a_robot_without_a_name_space_stands_beside_one_that_has_it(
    write: Callable[..., Path],
) -> None:
    tree = frames_of(write({"": ROBOT, "/b": ROBOT}, "", "/b"))
    assert set(tree.frames) == {"map", *ROBOT, *(f"b/{frame}" for frame in ROBOT)}
    assert tree.parent("b/odom") == "map"


def test_a_root_that_one_robot_hangs_elsewhere_is_shared_no_longer(
    write: Callable[..., Path],
) -> None:
    below = {"base_link": "odom"}
    assert "odom" in frames_of(write({"/a": below, "/b": below})).frames
    tree = frames_of(write({"/a": below, "/b": below | {"odom": "map"}}))
    assert "odom" not in tree.frames
    assert tree.parent("b/base_link") == "b/odom"
    assert tree.parent("a/base_link") == "a/odom"


@pytest.mark.parametrize(
    ("transforms", "described_in", "separate"),
    [
        (["/tf", "/tf_static"], ["/a/robot_description"], []),
        (["/a/tf", "/a/tf_static"], ["/a/robot_description"], []),
        (["/a/tf", "/b/tf_static"], [], ["/a", "/b"]),
        (["/tf", "/a/tf"], ["/a/robot_description"], []),
        (["/tf", "/a/tf"], ["/a/robot_description", "/robot_description"], ["/a"]),
        (["/tf", "/a/tf"], ["/a/robot_description", "/b/robot_description"], ["/a"]),
        # A robot without transforms has its name space all the same.
        (["/a/tf"], ["/a/robot_description", "/b/robot_description"], ["/a", "/b"]),
        (["/a/tf"], ["/a/robot_description", "/robot_description"], ["/a"]),
        ([], ["/a/robot_description", "/b/robot_description"], ["/a", "/b"]),
        (["/a/tf"], ["/b/robot_description"], []),
        (["/tf"], ["/a/robot_description", "/b/robot_description"], []),
        (["/moves"], ["/a/robot_description", "/b/robot_description"], []),
        # Foxglove's transforms are global, whatever their topics are called.
        (["/camera/pose", "/lidar/pose"], [], []),
    ],
)
def test_name_spaces_are_kept_apart_where_there_are_several(
    transforms: Sequence[str], described_in: Sequence[str], separate: Sequence[str]
) -> None:
    assert separate_spaces(transforms, described_in) == separate


def transforms(*edges: FramePair) -> Transforms:
    return [(0, tuple(edges), np.zeros((len(edges), 7)))]


def any_trees(seed: int) -> dict[str, list[FramePair]]:
    """Trees of some name spaces, of names that look like those of others."""
    chance, found = random.Random(seed), dict[str, list[FramePair]]()
    for space in SPACES[:3]:
        names = chance.sample(NAMES, chance.randint(2, len(NAMES)))
        found[space] = [
            (chance.choice(names[:number]), name)
            for number, name in enumerate(names)
            if number
        ]
    return found


@pytest.mark.parametrize("seed", range(50))
def test_frames_of_name_spaces_never_touch_each_other_whatever_their_names(
    seed: int,
) -> None:
    trees, spaces = any_trees(seed), NameSpaces()
    spaces.set_spaces(trees)
    told = [(space, edge) for space, edges in trees.items() for edge in edges]
    random.Random(-seed).shuffle(told)
    # The names hold once all have told of their frames.
    for space, edge in told:
        spaces.transforms(f"{space}/tf", transforms(edge))
    version = spaces.version
    named: dict[str, set[tuple[str, str]]] = {}
    for space, edge in told:
        [(_, [frames], _)] = spaces.transforms(f"{space}/tf", transforms(edge))
        for frame, name in zip(edge, frames, strict=True):
            named.setdefault(name, set()).add((space, frame))
            assert spaces.frame_of(f"{space}/scan", frame) == name
            assert spaces.link_frame(f"{space}/robot_description", frame) == name
    held = {child for _, (_, child) in told}
    for name, frames in named.items():
        # Only what hangs nowhere is one frame of several robots.
        assert len(frames) == 1 or {name} == {frame for _, frame in frames}
        assert len(frames) == 1 or name not in held
    assert spaces.version == version


def test_what_a_message_is_stamped_in_is_a_frame_of_its_robot() -> None:
    spaces = NameSpaces()
    spaces.set_spaces(["/a", "/b"])
    for space in "ab":
        edges = ("map", "odom"), ("odom", f"{space}/laser")
        spaces.transforms(f"/{space}/tf", transforms(*edges))
    assert spaces.frame_of("/b/scan", "odom") == "b/odom"
    assert spaces.frame_of("/b/scan", "b/laser") == "b/laser"
    # A robot sees another one; the map has no robot, and one topic has none.
    assert spaces.frame_of("/b/seen", "a/laser") == "a/laser"
    assert spaces.frame_of("/b/costmap", "map") == "map"
    assert spaces.frame_of("/fleet", "odom") == "odom"
    # Of a frame that only joints hold no transform tells.
    assert spaces.frame_of("/b/scan", "hand") == "b/hand"


def test_names_that_change_are_told_of() -> None:
    spaces = NameSpaces()
    spaces.set_spaces(["/a", "/b"])
    below = transforms(("odom", "base"))
    for space in "ab":
        spaces.transforms(f"/{space}/tf", below)
    [(_, [(parent, _)], _)] = spaces.transforms("/a/tf", below)
    assert parent == "odom"
    before = spaces.version
    spaces.transforms("/a/tf", transforms(("map", "odom")))
    assert spaces.version == before + 1
    [(_, [(parent, child)], _)] = spaces.transforms("/b/tf", below)
    assert (parent, child) == ("b/odom", "b/base")


def test_frames_of_robots_that_nothing_joins_have_no_place_in_each_other(
    write: Callable[..., Path],
) -> None:
    tree = frames_of(write({"/a": {"arm": "base_link"}, "/b": {"arm": "base_link"}}))
    with pytest.raises(LookupRefused):
        tree.lookup("a/arm", "b/arm")
