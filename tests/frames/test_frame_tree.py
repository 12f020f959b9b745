"""The frame tree: tf2's rules, tf2's texts, and what tf2 would let pass."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from close import is_close
from work import calls_of

from sambot_viz.errors import FrameError
from sambot_viz.frames import (
    FrameCycleError,
    FrameTree,
    LookupRefused,
    Transform,
    TransformRefused,
)


def at(x: float = 0, y: float = 0, z: float = 0, yaw: float = 0) -> Transform:
    return Transform.from_xyz_rpy((x, y, z), (0, 0, yaw))


@pytest.fixture
def tree() -> FrameTree:
    """map → odom → base_link → {base_laser, wheel}, and a lone pair beside it."""
    tree = FrameTree()
    tree.set_static("map", "odom", at(1))
    tree.set("odom", "base_link", at(2, yaw=math.pi / 2), stamp=5.0)
    tree.set_static("base_link", "base_laser", at(0.1, 0, 0.2))
    tree.set("base_link", "wheel", at(0, 0.3), stamp=7.0)
    tree.set_static("camera", "camera_optical", at())
    return tree


def test_the_tutorials_laser_is_where_the_tutorial_says() -> None:
    tree = FrameTree()
    tree.set_static("base_link", "base_laser", at(0.1, 0, 0.2))
    T = tree.lookup("base_link", "base_laser")
    # The tutorial: a point 0.3 m ahead of the laser is 0.4 m ahead of the base.
    point = T.matrix @ (0.3, 0.0, 0.0, 1.0)
    assert np.allclose(point, (0.4, 0.0, 0.2, 1.0), atol=1e-15)


def test_a_lookup_is_the_pose_of_the_source_in_the_target(tree: FrameTree) -> None:
    assert np.allclose(tree.lookup("map", "base_laser").translation, (3, 0.1, 0.2))
    assert np.allclose(tree.lookup("base_laser", "map").translation, (-0.1, 3, -0.2))
    assert np.allclose(tree.lookup("wheel", "base_laser").translation, (0.1, -0.3, 0.2))
    assert np.allclose(tree.lookup("odom", "map").translation, (-1, 0, 0))


def test_any_two_connected_frames_agree_with_the_way_over_the_root() -> None:
    random = np.random.default_rng(3)
    tree = FrameTree()
    T_root = {"f0": Transform.identity()}
    for i in range(1, 40):
        parent = f"f{random.integers(0, i)}"
        T = Transform.from_xyz_rpy(random.normal(size=3), random.normal(size=3))
        tree.set(parent, f"f{i}", T)
        T_root[f"f{i}"] = T_root[parent] @ T
    for target in tree.frames:
        for source in tree.frames:
            expected = T_root[target].inverse() @ T_root[source]
            assert is_close(tree.lookup(target, source), expected, 1e-12)


def test_the_same_name_twice_needs_no_data() -> None:
    assert FrameTree().lookup("nowhere", "nowhere") == Transform.identity()
    assert FrameTree().lookup("/nowhere", "nowhere") == Transform.identity()


def test_one_leading_slash_is_stripped_and_only_one() -> None:
    tree = FrameTree()
    tree.set_static("/base_link", "/base_laser", at(1))
    assert tree.frames == ("base_link", "base_laser")
    assert tree.lookup("/base_link", "base_laser").translation[0] == 1
    assert "/base_link" in tree
    with pytest.raises(LookupRefused):
        tree.lookup("//base_link", "base_laser")


def test_an_unknown_target_is_found_before_an_unknown_source(tree: FrameTree) -> None:
    with pytest.raises(LookupRefused) as caught:
        tree.lookup("base_lnk", "nothing")
    error = caught.value
    assert str(error) == "no frame 'base_lnk'; did you mean 'base_link'?"
    assert (error.reason, error.unknown) == ("unknown-frame", "base_lnk")
    assert error.tf2_text == (
        'Invalid frame ID "base_lnk" passed to canTransform argument target_frame'
        " - frame does not exist"
    )
    assert error.rviz_text == (
        "For frame [nothing]: Fixed Frame [base_lnk] does not exist"
    )


def test_an_unknown_source_has_its_own_texts(tree: FrameTree) -> None:
    with pytest.raises(LookupRefused) as caught:
        tree.lookup("map", "lidar")
    assert caught.value.tf2_text == (
        'Invalid frame ID "lidar" passed to canTransform argument source_frame'
        " - frame does not exist"
    )
    assert caught.value.rviz_text == "For frame [lidar]: Frame [lidar] does not exist"


def test_an_empty_name_is_refused_even_when_both_are_empty(tree: FrameTree) -> None:
    for target, argument in (("", "target_frame"), ("map", "source_frame")):
        with pytest.raises(LookupRefused) as caught:
            tree.lookup(target, "")
        assert caught.value.tf2_text == (
            f'Invalid frame ID "" passed to canTransform argument {argument}'
            " - in tf2 frame_ids cannot be empty"
        )


def test_separate_trees_have_tf2s_and_rvizs_texts(tree: FrameTree) -> None:
    with pytest.raises(LookupRefused) as caught:
        tree.lookup("map", "camera_optical")
    error = caught.value
    assert error.reason == "not-connected"
    assert error.tf2_text == (
        "Could not find a connection between 'map' and 'camera_optical' because they "
        "are not part of the same tree.Tf has two or more unconnected trees."
    )
    assert error.rviz_text == (
        f"No transform to fixed frame [map]. TF error: [{error.tf2_text}]"
    )
    assert str(error) == (
        "no way from 'camera_optical' to 'map': they belong to separate trees; "
        "a transform between the two trees is missing"
    )
    assert not tree.can_lookup("map", "camera_optical")
    assert tree.can_lookup("map", "wheel")


def test_a_frame_at_the_end_of_a_chain_takes_no_more_work_than_the_first() -> None:
    tree, names = FrameTree(), [f"f{i}" for i in range(200)]
    work = [
        calls_of(lambda p=parent, c=child: tree.set_static(p, c, at(1)))
        for parent, child in itertools.pairwise(names)
    ]
    assert work[-1] <= work[1]


def test_a_ring_is_refused_with_the_ring(tree: FrameTree) -> None:
    before = tree.frames
    with pytest.raises(FrameCycleError) as caught:
        tree.set("base_laser", "odom", at())
    assert caught.value.ring == ("base_laser", "odom", "base_link", "base_laser")
    assert str(caught.value) == (
        "'base_laser' cannot be the parent of 'odom', because it is already below "
        "it and the frames would form a ring: base_laser → odom → base_link → "
        "base_laser; turn the transform round or remove the other one"
    )
    assert caught.value.tf2_text == "The tf tree is invalid because it contains a loop."
    assert tree.frames == before
    assert tree.lookup("map", "base_laser")


@pytest.mark.parametrize(
    ("parent", "child", "name"),
    [
        ("a", "a", "TF_SELF_TRANSFORM"),
        ("a", "/a", "TF_SELF_TRANSFORM"),
        ("", "a", "TF_NO_FRAME_ID"),
        ("/", "a", "TF_NO_FRAME_ID"),
        ("a", "", "TF_NO_CHILD_FRAME_ID"),
    ],
)
def test_what_listeners_ignore_is_refused_by_name(
    parent: str, child: str, name: str
) -> None:
    tree = FrameTree()
    with pytest.raises(TransformRefused) as caught:
        tree.set_static(parent, child, at())
    assert caught.value.tf2_name == name
    assert tree.frames == ()


def test_a_frame_has_one_parent_and_the_latest_wins(tree: FrameTree) -> None:
    version = tree.version
    tree.set_static("map", "wheel", at(9))
    assert tree.parent("wheel") == "map"
    assert tree.children("base_link") == ("base_laser",)
    assert tree.version > version
    assert tree.lookup("map", "wheel").translation[0] == 9


def test_a_parent_that_lost_its_only_child_stays_known() -> None:
    tree = FrameTree()
    tree.set("a", "b", at())
    tree.set("c", "b", at())
    assert tree.frames == ("a", "b", "c")
    assert tree.roots == ("a", "c")


def test_frames_are_listed_in_the_order_learnt(tree: FrameTree) -> None:
    assert tree.frames == (
        "map",
        "odom",
        "base_link",
        "base_laser",
        "wheel",
        "camera",
        "camera_optical",
    )
    assert tree.roots == ("map", "camera")
    assert tree.root_of("wheel") == "map"
    assert tree.parent("map") is None
    assert len(tree) == 7


def test_removing_a_frame_cuts_it_off_with_what_hangs_below(tree: FrameTree) -> None:
    tree.remove("base_link")
    assert "base_link" in tree
    assert tree.roots == ("map", "base_link", "camera")
    assert tree.lookup("base_link", "wheel")
    tree.remove("camera_optical")
    assert "camera" not in tree
    with pytest.raises(FrameError, match=r"^frame 'map' is a root: it has no parent$"):
        tree.remove("map")
    with pytest.raises(FrameError, match=r"^no frame 'camera'"):
        tree.remove("camera")
    tree.clear()
    assert len(tree) == 0


def test_the_chain_is_walked_from_the_source(tree: FrameTree) -> None:
    hops = tree.chain("base_laser", "wheel")
    assert [(h.parent, h.child, h.up, h.static, h.stamp) for h in hops] == [
        ("base_link", "wheel", True, False, 7.0),
        ("base_link", "base_laser", False, True, 0.0),
    ]
    assert tree.chain("map", "map") == ()


def test_the_time_of_a_lookup_is_the_oldest_of_the_latest(tree: FrameTree) -> None:
    assert tree.latest_common_time("map", "wheel") == 5.0
    assert tree.latest_common_time("base_link", "base_laser") == 0.0


def test_an_update_moves_joints_without_changing_the_structure(tree: FrameTree) -> None:
    version = tree.version
    tree.update({"wheel": at(yaw=1).matrix, "base_link": at(4).matrix}, stamp=8.0)
    assert tree.version == version
    assert np.allclose(tree.lookup("map", "wheel").translation, (5, 0, 0))
    assert tree.hop("wheel").stamp == 8.0


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_bad_number_in_an_update_changes_nothing(tree: FrameTree, bad: float) -> None:
    before = tree.lookup("map", "wheel")
    matrix = np.eye(4)
    matrix[1, 1] = bad
    with pytest.raises(TransformRefused, match=r"^TF_NAN_INPUT: .*'base_link'"):
        tree.update({"wheel": at(1).matrix, "base_link": matrix})
    assert tree.lookup("map", "wheel") == before


def test_an_update_of_a_frame_without_parent_is_refused(tree: FrameTree) -> None:
    with pytest.raises(FrameError, match=r"^no frame 'weel'; did you mean 'wheel'\?$"):
        tree.update({"weel": np.eye(4)})
    with pytest.raises(FrameError, match="is a root"):
        tree.update({"map": np.eye(4)})


def test_a_frame_can_be_declared_before_any_transform_names_it() -> None:
    tree = FrameTree()
    tree.declare("/base_link")
    version = tree.version
    tree.declare("base_link")
    assert (tree.frames, tree.roots, tree.version) == (
        ("base_link",),
        ("base_link",),
        version,
    )
    tree.set("base_link", "wheel", at())
    tree.remove("wheel")
    assert tree.frames == ("base_link",)
    with pytest.raises(TransformRefused, match="TF_NO_FRAME_ID"):
        tree.declare("")
    tree.clear()
    assert tree.frames == ()


def test_an_answer_never_outlives_a_change(tree: FrameTree) -> None:
    tree.update({"wheel": at(1).matrix})
    assert tree.lookup("base_link", "wheel").translation[0] == 1
    tree.update({"wheel": at(2).matrix})
    assert tree.lookup("base_link", "wheel").translation[0] == 2
    tree.set("base_link", "wheel", at(3))
    assert tree.lookup("base_link", "wheel").translation[0] == 3
    tree.remove("wheel")
    with pytest.raises(LookupRefused):
        tree.lookup("base_link", "wheel")


def test_all_pairs_of_many_frames_can_be_asked_for() -> None:
    tree = FrameTree()
    for i in range(80):
        tree.set("root", f"f{i}", at(i))
    for target in tree.frames:
        for source in tree.frames:
            tree.lookup(target, source)
    assert tree.lookup("f3", "f10").translation[0] == 7
