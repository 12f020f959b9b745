"""tf2's buffer: recorded outcomes, its texts word for word, and its rules by chance.

`drives.json` has three drives of the tutorial's robot round a square, as recorded: for
each transform the time of its message, its frames, its stamp and pose (times in
nanoseconds after 1,750,000,000 s), and where the real tf2 (C++, 10 s) saw the frames in
odom at the newest common time when the messages up to a time had been taken.
"""

from __future__ import annotations

import bisect
import json
import math
import random
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lower_limit import lower

from sambot_viz.frames import FrameHistory, FrameTree, LookupRefused, Transform
from sambot_viz.frames import samples as samples_module
from sambot_viz.frames.samples import Pose, Samples

START = 1_750_000_000 * 10**9
SECOND = 10**9
RECORDED = Path(__file__).with_name("drives.json")
DRIVES: dict[str, Any] = json.loads(RECORDED.read_text("utf-8"))
HERE = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]


def put(
    history: FrameHistory,
    parent: str,
    child: str,
    stamp: int,
    x: float = 0.0,
    xyzw: tuple[float, float, float, float] = (0, 0, 0, 1),
) -> dict[int, str]:
    return {**history.add(stamp, ((parent, child),), np.array([[x, 0, 0, *xyzw]]))}


def play(history: FrameHistory, drive: Any, until: int, taken: int = 0) -> int:
    """Take the messages of a drive up to a time; how many were taken."""
    messages = drive["messages"]
    while taken < len(messages) and messages[taken][0] <= until:
        _, number, stamp, *pose = messages[taken]
        parent, child, static = drive["edges"][number]
        if static:
            history.add_static(parent, child, (tuple(pose[:3]), tuple(pose[3:])))
        else:
            history.add(START + stamp, ((parent, child),), np.array([pose]))
        taken += 1
    return taken


def seen(tree: FrameTree, target: str, source: str, stamp: int | None = None) -> Any:
    return tree.lookup(target, source, stamp).translation.tolist()


@pytest.mark.parametrize("name", DRIVES)
def test_frames_are_where_the_real_tf2_saw_them(name: str) -> None:
    drive = DRIVES[name]
    history, taken = FrameHistory(), 0
    assert len(drive["shown"]) > 10
    for at, frame, expected in drive["shown"]:
        taken = play(history, drive, at, taken)
        if expected is None:
            with pytest.raises(LookupRefused):
                history.lookup("odom", frame)
            continue
        stamp, *pose = expected
        assert history.latest_common_time("odom", frame) == START + stamp
        found = history.lookup("odom", frame)
        assert found.translation.tolist() == pytest.approx(pose[:3], abs=1e-6)
        turned = abs(float(np.dot(found.rotation_xyzw, pose[3:])))
        assert turned == pytest.approx(1.0, abs=1e-6)


def test_between_messages_the_robot_is_on_its_way() -> None:
    """The first side of the square is 1 m at 0.25 m/s, then a corner in one second."""
    history = FrameHistory()
    play(history, DRIVES["square"], 9 * SECOND)
    chance = random.Random(1)
    for _ in range(200):
        at = chance.uniform(0.01, 3.99)
        found = history.lookup("odom", "base_footprint", START + round(at * 1e9))
        assert found.translation.tolist() == pytest.approx([0.25 * at, 0, 0], abs=1e-7)
        at = chance.uniform(4.04, 4.96)
        found = history.lookup("odom", "lidar_link", START + round(at * 1e9))
        assert found.rpy[2] == pytest.approx((at - 4) * math.pi / 2, abs=1e-6)
        assert found.translation.tolist() == pytest.approx([1, 0, 0.27], abs=1e-7)


def test_ten_seconds_are_kept() -> None:
    history = FrameHistory()
    play(history, DRIVES["square"], 14 * SECOND)
    newest = history.latest_common_time("odom", "base_link")
    assert newest is not None
    history.lookup("odom", "base_link", newest - 10 * SECOND)
    with pytest.raises(LookupRefused) as caught:
        history.lookup("odom", "base_link", newest - 10 * SECOND - 40_000_000)
    assert caught.value.reason == "extrapolation-past"
    assert put(history, "odom", "base_link", newest - 11 * SECOND) == {0: "TF_OLD_DATA"}
    assert put(history, "odom", "base_link", newest - 9 * SECOND) == {}


def test_refusals_have_the_words_of_tf2() -> None:
    history = FrameHistory()
    put(history, "map", "odom", START + SECOND)
    texts: dict[int, str] = {}
    for step, stamp in enumerate((START, START + 3 * SECOND, START + SECOND // 2)):
        if step == 1:
            put(history, "map", "odom", START + 2 * SECOND)
        with pytest.raises(LookupRefused) as caught:
            history.lookup("map", "odom", stamp)
        texts[step] = caught.value.tf2_text
        assert f"TF error: [{texts[step]}]" in caught.value.rviz_text
    frames = ", when looking up transform from frame [odom] to frame [map]"
    assert texts == {
        0: "Lookup would require extrapolation at time 1750000000.000000, but only "
        f"time 1750000001.000000 is in the buffer{frames}",
        1: "Lookup would require extrapolation into the future.  Requested time "
        "1750000003.000000 but the latest data is at time 1750000002.000000" + frames,
        2: "Lookup would require extrapolation into the past.  Requested time "
        "1750000000.500000 but the earliest data is at time 1750000001.000000" + frames,
    }


def test_refusals_say_in_our_words_how_far_the_data_is() -> None:
    history = FrameHistory()
    put(history, "map", "odom", START)
    put(history, "map", "odom", START + SECOND)
    with pytest.raises(LookupRefused, match=r"the latest data is 2\.5 s older"):
        history.lookup("map", "odom", START + 7 * SECOND // 2)
    with pytest.raises(LookupRefused, match=r"the earliest data is 0\.25 s newer"):
        history.lookup("map", "odom", START - SECOND // 4)
    with pytest.raises(LookupRefused, match="no frame 'odm'; did you mean 'odom'"):
        history.lookup("map", "odm", START)
    put(history, "world", "table", START)
    with pytest.raises(LookupRefused) as caught:
        history.lookup("map", "table", START)
    assert caught.value.tf2_text.startswith("Could not find a connection between 'map'")


def test_nothing_is_interpolated_across_a_new_parent() -> None:
    history = FrameHistory()
    history.add_static("world", "a", ((0, 0, 0), (0, 0, 0, 1)))
    history.add_static("world", "b", ((100, 0, 0), (0, 0, 0, 1)))
    put(history, "a", "cup", START, 1.0)
    put(history, "b", "cup", START + SECOND, 3.0)
    assert history.lookup("world", "cup", START + SECOND // 2).translation[0] == 1.0
    assert history.lookup("world", "cup", START + SECOND).translation[0] == 103.0


def test_rotations_take_the_shorter_arc_at_an_even_pace() -> None:
    history = FrameHistory()
    put(history, "a", "b", START)
    half = math.radians(80) / 2
    # The same rotation of 80 degrees, with the other sign of the quaternion.
    turned = (0.0, 0.0, -math.sin(half), -math.cos(half))
    put(history, "a", "b", START + SECOND, xyzw=turned)
    for share in (0.1, 0.25, 0.5, 0.9):
        found = history.lookup("a", "b", START + round(share * 1e9))
        assert found.rpy[2] == pytest.approx(math.radians(80) * share)


def test_the_latest_common_time_is_that_of_the_slowest_frame() -> None:
    history = FrameHistory()
    put(history, "map", "odom", START + SECOND)
    for tenth in range(15):
        put(history, "odom", "base", START + tenth * SECOND // 10, tenth / 10)
    history.add_static("base", "laser", ((0, 0, 0.2), (0, 0, 0, 1)))
    assert history.latest_common_time("map", "laser") == START + SECOND
    assert history.latest_common_time("odom", "laser") == START + 14 * SECOND // 10
    assert history.latest_common_time("base", "laser") is None
    # As tf2 does it: all frames at that time, not each at its own newest.
    assert history.lookup("map", "laser").translation[0] == pytest.approx(1.0)
    assert history.lookup("base", "laser").translation[2] == pytest.approx(0.2)


def test_a_way_below_a_gap_is_still_a_way() -> None:
    """What is unknown above the frame that both have in common does not matter."""
    history = FrameHistory()
    put(history, "map", "base", START)
    for child, x in (("left", 1.0), ("right", -1.0)):
        put(history, "base", child, START + 5 * SECOND, x)
    assert history.lookup("left", "right", START + 5 * SECOND).translation[0] == -2.0
    with pytest.raises(LookupRefused):
        history.lookup("map", "right", START + 5 * SECOND)


def test_a_static_transform_takes_the_place_of_a_moving_one_and_back() -> None:
    history = FrameHistory()
    edges = (("map", "a"), ("map", "b"))
    poses = np.array([HERE, HERE])
    history.add(START, edges, poses)
    history.add_static("map", "a", ((7, 0, 0), (0, 0, 0, 1)))
    assert history.lookup("map", "a", START + 99 * SECOND).translation[0] == 7.0
    assert history.lookup("map", "b", START).translation[0] == 0.0
    history.add(START + SECOND, edges, poses)
    assert history.lookup("map", "a", START + SECOND).translation[0] == 0.0
    with pytest.raises(LookupRefused):
        history.lookup("map", "a", START)
    history.lookup("map", "b", START + SECOND // 2)


def test_after_a_jump_only_static_transforms_are_left() -> None:
    history = FrameHistory()
    put(history, "odom", "base", START)
    history.add_static("base", "laser", ((0, 0, 0.2), (0, 0, 0, 1)))
    history.clear()
    assert history.lookup("base", "laser").translation[2] == pytest.approx(0.2)
    with pytest.raises(LookupRefused):
        history.lookup("odom", "base")
    assert put(history, "odom", "base", START - 100 * SECOND) == {}
    history.lookup("odom", "laser", START - 100 * SECOND)


def test_transforms_that_tf2_ignores_are_named_and_the_others_taken() -> None:
    history = FrameHistory()
    names = [
        ("map", "good"),
        ("map", "nan"),
        ("map", "map"),
        ("", "a"),
        ("map", "/"),
        ("map", "long"),
        ("/map", "/slash"),
    ]
    poses = np.array([HERE] * len(names))
    poses[1, 0] = math.nan
    poses[5, 6] = 1.2
    assert history.add(START, names, poses) == {
        1: "TF_NAN_INPUT",
        2: "TF_SELF_TRANSFORM",
        3: "TF_NO_FRAME_ID",
        4: "TF_NO_CHILD_FRAME_ID",
        5: "TF_DENORMALIZED_QUATERNION",
    }
    assert history.frames == ("map", "good", "slash")
    assert (
        history.add_static("a", "a", ((0, 0, 0), (0, 0, 0, 1))) == "TF_SELF_TRANSFORM"
    )
    assert history.add_static("a", "b", ((0, 0, 0), (0, 0, 0, 9))) is not None
    history.lookup("slash", "good", START)


def test_a_ring_is_refused_when_it_is_looked_through() -> None:
    history = FrameHistory()
    put(history, "a", "b", START)
    put(history, "b", "a", START)
    put(history, "a", "leaf", START)
    put(history, "world", "table", START)
    for stamp in (None, START):
        with pytest.raises(LookupRefused) as caught:
            history.lookup("table", "leaf", stamp)
        assert caught.value.tf2_text == (
            "The tf tree is invalid because it contains a loop."
        )


def test_the_tree_of_a_robot_is_looked_up_together_with_a_history() -> None:
    """Sliders say where the wheels are; the robot itself drives."""
    history = FrameHistory()
    tree = FrameTree(history)
    tree.set("base", "wheel", Transform.from_xyz_rpy((0, 0.2, 0)))
    put(history, "odom", "base", START, 0.0)
    put(history, "odom", "base", START + SECOND, 2.0)
    assert seen(tree, "odom", "wheel") == [2.0, 0.2, 0.0]
    assert seen(tree, "odom", "wheel", START + SECOND // 2) == [1.0, 0.2, 0.0]
    assert tree.can_lookup("odom", "wheel", START)
    assert not tree.can_lookup("odom", "wheel", START - 1)
    assert not tree.can_lookup("odom", "whel")
    assert seen(tree, "base", "wheel", START - 99 * SECOND) == [0.0, 0.2, 0.0]


def test_a_tree_without_a_history_holds_at_all_times() -> None:
    tree = FrameTree()
    tree.set("base", "wheel", Transform.from_xyz_rpy((0, 0.2, 0)))
    assert tree.history is None
    assert seen(tree, "base", "wheel", START) == [0.0, 0.2, 0.0]


class PlainHistory:
    """The same rules in the plainest way: each frame a sorted list, searched anew."""

    def __init__(self) -> None:
        self.frames: dict[str, list[tuple[int, str, Pose]]] = {}

    def add(self, stamp: int, parent: str, child: str, pose: Pose) -> bool:
        line = self.frames.setdefault(child, [])
        if line and stamp < line[-1][0] - 10 * SECOND:
            return False
        line[:] = [entry for entry in line if entry[0] != stamp]
        bisect.insort(line, (stamp, parent, pose))
        line[:] = [entry for entry in line if entry[0] >= line[-1][0] - 10 * SECOND]
        return True

    def x_in_root(self, child: str, stamp: int) -> float | None:
        """The x of a frame in its root, for poses that do not turn."""
        x = 0.0
        while child in self.frames:
            line = self.frames[child]
            older = [entry for entry in line if entry[0] <= stamp]
            newer = [entry for entry in line if entry[0] > stamp]
            if not older or (not newer and stamp > older[-1][0]):
                return None
            (t0, parent, ((x0, _, _), _)) = older[-1]
            x += x0
            if newer and newer[0][1] == parent:
                t1, _, ((x1, _, _), _) = newer[0]
                x += (x1 - x0) * (stamp - t0) / (t1 - t0)
            child = parent
        return x


@pytest.mark.parametrize("seed", range(30))
def test_messages_in_any_order_and_grouping_give_what_the_plain_rules_give(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    chance = random.Random(seed)
    if seed % 3 == 0:
        monkeypatch.setattr(samples_module, "MOST_GROUPS", 4)
    plain, history = PlainHistory(), FrameHistory()
    names = ["root", "a", "b", "c", "d"]
    for _ in range(chance.randint(5, 150)):
        stamp = START + chance.choice([SECOND, SECOND // 4]) * chance.randint(0, 60)
        rows = [
            (chance.choice(names[:i]), names[i])
            if chance.random() < 0.1
            else (names[i - 1], names[i])
            for i in sorted(chance.sample(range(1, 5), chance.randint(1, 4)))
        ]
        xs = [chance.uniform(-5, 5) for _ in rows]
        poses = np.array([[x, *HERE[1:]] for x in xs])
        faults = history.add(stamp, tuple(rows), poses)
        for row, (parent, child) in enumerate(rows):
            pose: Pose = ((xs[row], 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
            assert plain.add(stamp, parent, child, pose) == (row not in faults)
    for _ in range(200):
        stamp = START + chance.randint(-1, 125) * SECOND // 2
        child = chance.choice(names[1:])
        expected = plain.x_in_root(child, stamp)
        if child not in plain.frames or expected is None:
            with pytest.raises(LookupRefused):
                history.lookup("root", child, stamp)
        else:
            found = history.lookup("root", child, stamp).translation[0]
            assert found == pytest.approx(expected, abs=1e-9)


def test_three_hundred_frames_at_a_thousand_messages_a_second_are_cheap() -> None:
    """In one run beside the decoding of as many numbers from text, to have a scale."""
    edges = tuple((f"f{n // 2}", f"f{n + 1}") for n in range(300))
    poses = np.tile(HERE, (300, 1))
    history = FrameHistory()
    start = time.process_time()
    for step in range(1000):
        history.add(START + step * SECOND // 1000, edges, poses)
    cost = time.process_time() - start
    text = " ".join(map(str, poses.ravel().tolist()))
    start = time.process_time()
    for _ in range(100):
        list(map(float, text.split()))
    scale = 10 * (time.process_time() - start)

    assert cost < scale, (cost, scale)


def test_the_memory_has_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    lower(monkeypatch, "POSES", 1000)
    kept = Samples(10 * SECOND)
    edges = tuple(("map", f"f{n}") for n in range(10))
    for step in range(3000):
        kept.add(START + step, edges, np.tile(HERE, (10, 1)))
    stamps = [START + step for step in range(3000)]
    known = [stamp for stamp in stamps if hasattr(kept.at("f3", stamp), "pose")]
    assert 90 <= len(known) <= 120
    assert known[-1] == stamps[-1]
