"""Two robots with name spaces in a session: their links, joints and data."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from inside import session_of
from live_peers import eventually
from made_recording import (
    START,
    Message,
    described,
    header,
    store_of_all,
    write_messages,
)
from made_recording import transforms_message as moved
from numpy.typing import NDArray
from robot_peer import HesitantPeer

from sambot_viz import Visualizer
from sambot_viz.cli import main
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.sources.bag import open_recording
from sambot_viz.text import capitalized

ROBOTS = ("a", "b")
POSITIONS = {"a": 0.25, "b": 1.0}
JOINT = "base_link_arm"


def messages() -> Iterator[Message]:
    """Of two robots: odom is where the number of seconds says, arms are turned."""
    store = store_of_all()
    types, time = store.types, START * 1_000_000_000
    urdf = described("base_link", "arm")
    for robot, position in POSITIONS.items():
        text, state = "std_msgs/msg/String", "sensor_msgs/msg/JointState"
        yield f"/{robot}/robot_description", text, time, types[text](urdf)
        trees = {"odom": "map"}, {"base_link": "odom", "laser": "base_link"}
        for seconds, tree in zip((2.0 * position, 0.0), trees, strict=True):
            name = "tf2_msgs/msg/TFMessage"
            yield f"/{robot}/tf_static", name, time, moved(store, seconds, tree)
        none, at = np.zeros(0), header(store, 0.0, "")
        told = types[state](at, [JOINT], np.array([position]), none, none)
        yield f"/{robot}/joint_states", state, time, told
        point = types["geometry_msgs/msg/Point"](1.0, 0.0, 0.0)
        name, at = "geometry_msgs/msg/PointStamped", header(store, 0.0, "laser")
        yield f"/{robot}/point", name, time, types[name](at, point)


def turned(viz: Visualizer, robot: str) -> NDArray[np.float64]:
    return viz.frames.lookup(f"{robot}/base_link", f"{robot}/arm").matrix[:3, :3]


def expected(robot: str) -> NDArray[np.float64]:
    c, s = np.cos(POSITIONS[robot]), np.sin(POSITIONS[robot])
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def are_shown(viz: Visualizer) -> bool:
    """Whether both robots are at their places, with their joints, and their data."""
    frames = viz.frames
    needed = [f"{r}/{link}" for r in ROBOTS for link in ("base_link", "arm")]
    return all(
        frame in frames and frames.can_lookup("map", frame) for frame in needed
    ) and all(np.allclose(turned(viz, robot), expected(robot)) for robot in ROBOTS)


def is_fine(viz: Visualizer) -> bool:
    displays = session_of(viz).scene.displays
    found = [d.status.level for d in displays if d.kind.endswith("PointStamped")]
    return found == ["Ok", "Ok"]


def check(viz: Visualizer) -> None:
    session = session_of(viz)
    displays = session.scene.displays
    models = [d for d in displays if isinstance(d, RobotModelDisplay)]
    assert [str(d.config.get("Description Topic")) for d in models] == [
        "/a/robot_description",
        "/b/robot_description",
    ]
    assert [d.frame_of("arm") for d in models] == ["a/arm", "b/arm"]
    assert [d.status.level for d in models] == ["Ok", "Ok"]
    for robot, position in POSITIONS.items():
        at = viz.frames.lookup("map", f"{robot}/base_link").translation
        assert at.tolist() == pytest.approx([2.0 * position, 0.0, 0.0])
        assert viz.frames.parent(f"{robot}/laser") == f"{robot}/base_link"
    assert not {"odom", "base_link", "arm", "laser"} & {*viz.frames.frames}


@pytest.fixture(params=[1, -1], ids=["in order", "in the other order"])
def recording(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    return write_messages(tmp_path / "robots.mcap", [*messages()][:: request.param])


def test_a_recording_shows_both_robots(recording: Path) -> None:
    with Visualizer(recording, port=0) as viz:
        eventually(lambda: are_shown(viz))
        eventually(lambda: is_fine(viz))
        check(viz)


def test_a_live_source_shows_both_robots(recording: Path) -> None:
    with open_recording(recording) as played:
        peer = HesitantPeer(played)
        try:
            for topic in played.topics:
                peer.offer(topic)
            with Visualizer(source=peer.uri, port=0) as viz:
                eventually(lambda: peer.say_all() or are_shown(viz))
                eventually(lambda: is_fine(viz))
                check(viz)
        finally:
            peer.stop()


# Who stands where


@dataclass(frozen=True)
class Case:
    """Robots whose descriptions call their frames alike, and what is to be seen.

    Attributes:
        told: topic → the parent of each child, and how far along x [m].
        at: frame → where it is in the fixed frame along x, and turned about z.
        said: topic → words of what is said of it.
        described: topics of descriptions.
    """

    told: Mapping[str, tuple[Mapping[str, str], float]]
    at: Mapping[str, tuple[float, float]]
    said: Mapping[str, str] = field(default_factory=dict[str, str])
    described: tuple[str, ...] = tuple(f"/{robot}/robot_description" for robot in "ab")


BELOW = {"base_link": "odom"}
IN_MAP = {"odom": "map", "base_link": "odom"}
B = "/b/robot_description"
CASES = {
    "the frames of both on one topic": Case(
        {"/tf": (IN_MAP, 1.0)},
        {"base_link": (2.0, 0.0), "arm": (2.0, 0.25)},
        {B: "of /a/robot_description too, and both robots are drawn at one place"},
    ),
    "no transforms of one": Case(
        {"/a/tf": (IN_MAP, 1.0)},
        {"a/base_link": (2.0, 0.0), "a/arm": (2.0, 0.25)},
        {B: 'Add it: --static-transform "0 0 0 0 0 0 map b/base_link"'},
    ),
    "no transforms of the first one": Case(
        {"/b/tf": (IN_MAP, 1.0)},
        {"b/base_link": (2.0, 0.0), "b/arm": (2.0, 1.0)},
        {"/a/robot_description": "0 0 0 0 0 0 map a/base_link"},
    ),
    "one is placed on the topic of all, as it was said": Case(
        {"/a/tf": (IN_MAP, 1.0), "/tf_static": ({"b/base_link": "map"}, 5.0)},
        {"a/arm": (2.0, 0.25), "b/base_link": (5.0, 0.0), "b/arm": (5.0, 1.0)},
    ),
    "odom is all that they share": Case(
        {"/a/tf": (BELOW, 1.0), "/b/tf": (BELOW, 3.0)},
        {"a/arm": (1.0, 0.25), "b/base_link": (3.0, 0.0), "b/arm": (3.0, 1.0)},
    ),
    "odom, with a robot without a name space": Case(
        {"/tf": (BELOW, 1.0), "/b/tf": (BELOW, 3.0)},
        {"arm": (1.0, 0.25), "b/arm": (3.0, 1.0)},
        described=("/robot_description", B),
    ),
    "one has no name space, and none of the transforms": Case(
        {"/tf": (IN_MAP, 1.0), "/b/tf": (IN_MAP, 3.0)},
        {"arm": (2.0, 0.25), "b/arm": (6.0, 1.0)},
        described=("/a/robot_description", B),
    ),
    "nothing joins them": Case(
        {"/a/tf": ({"odom": "base_link"}, 1.0), "/b/tf": ({"odom": "base_link"}, 3.0)},
        {"a/odom": (1.0, 0.0), "a/arm": (0.0, 0.25)},
        {B: 'static-transform "0 0 0 0 0 0 a/base_link b/base_link"'},
    ),
}


def messages_of(case: Case) -> Iterator[Message]:
    store = store_of_all()
    types, time = store.types, START * 1_000_000_000
    text, state = "std_msgs/msg/String", "sensor_msgs/msg/JointState"
    for topic, position in zip(case.described, POSITIONS.values(), strict=True):
        yield topic, text, time, types[text](described("base_link", "arm"))
        none, none_at = np.zeros(0), header(store, 0.0, "")
        turned = types[state](none_at, [JOINT], np.array([position]), none, none)
        yield topic.replace("robot_description", "joint_states"), state, time, turned
    for topic, (tree, metres) in case.told.items():
        yield topic, "tf2_msgs/msg/TFMessage", time, moved(store, metres, tree)


def places(viz: Visualizer) -> dict[str, tuple[float, float]]:
    """Frame → where it is drawn in the fixed frame along x, and turned about z."""
    context = session_of(viz).scene.context
    found: dict[str, tuple[float, float]] = {}
    for frame in viz.frames.frames:
        if (T := context.pose(frame)) is not None:
            found[frame] = T[0, 3], np.arctan2(T[1, 0], T[0, 0])
    return found


def said_of(viz: Visualizer) -> dict[str, str]:
    """Robot's topic → what its account says, and its display, and Problems."""
    session = session_of(viz)
    with session.change():
        problems = [one.message for one in session.problems.shown.value.listed]
        models = [d for d in session.scene.displays if isinstance(d, RobotModelDisplay)]
        shown = {
            str(d.config.get("Description Topic")): d.status.rows["Topic"].text
            for d in models
        }
    found: dict[str, str] = {}
    for topic, text in shown.items():
        reason = viz.topics[topic].reason
        if reason is not None:
            assert text == capitalized(reason.text)
            assert any(f"{topic}: {reason.text}" in one for one in problems)
            found[topic] = reason.text
    return found


def is_as(case: Case, viz: Visualizer) -> bool:
    at, said = places(viz), said_of(viz)
    assert {frame: at.get(frame) for frame in case.at} == {
        frame: pytest.approx(place) for frame, place in case.at.items()
    }
    assert said.keys() == case.said.keys()
    assert all(words in said[topic] for topic, words in case.said.items())
    return True


@pytest.mark.parametrize("name", CASES)
def test_each_robot_stands_at_its_place_or_it_is_said_why_not(
    tmp_path: Path, name: str
) -> None:
    case = CASES[name]
    path = write_messages(tmp_path / "robots.mcap", messages_of(case))
    with Visualizer(path, port=0) as viz:
        viz.player.pause()
        eventually(lambda: is_as(case, viz))


@pytest.mark.parametrize("is_turned", [False, True], ids=["by name", "from the last"])
@pytest.mark.parametrize("name", CASES)
def test_it_does_not_matter_which_topic_of_a_live_robot_is_there_first(
    tmp_path: Path, name: str, is_turned: bool
) -> None:
    case = CASES[name]
    path = write_messages(tmp_path / "robots.mcap", messages_of(case))
    with open_recording(path) as played:
        peer = HesitantPeer(played)

        def is_so() -> bool:
            peer.say_all()
            return is_as(case, viz)

        try:
            with Visualizer(source=peer.uri, port=0) as viz:
                for topic in sorted(played.topics, reverse=is_turned):
                    peer.offer(topic)
                    eventually(lambda topic=topic: topic in viz.topics)
                    peer.say_all()
                eventually(is_so)
        finally:
            peer.stop()


def test_a_robot_keeps_its_place_while_its_transforms_are_published_again(
    tmp_path: Path,
) -> None:
    case = CASES["odom is all that they share"]
    path = write_messages(tmp_path / "robots.mcap", messages_of(case))
    with open_recording(path) as played:
        peer = HesitantPeer(played)
        try:
            for topic in played.topics:
                peer.offer(topic)
            with Visualizer(source=peer.uri, port=0) as viz:
                eventually(lambda: peer.say_all() or is_as(case, viz))
                robot = session_of(viz).data
                assert robot is not None
                peer.remove("/a/tf")
                eventually(lambda: "/a/tf" not in robot.transforms.topics)
                # It may be the other one whose joints are followed by now.
                eventually(lambda: peer.say_all() or is_as(case, viz))
                peer.offer("/a/tf")
                eventually(lambda: "/a/tf" in robot.transforms.topics)
                eventually(lambda: peer.say_all() or is_as(case, viz))
        finally:
            peer.stop()


@pytest.mark.parametrize("name", CASES)
def test_the_list_of_topics_says_the_same(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    case = CASES[name]
    path = write_messages(tmp_path / "robots.mcap", messages_of(case))
    assert main(["topics", str(path), "--format", "json"]) == 0
    listed = json.loads(capsys.readouterr().out)["topics"]
    said = {one["name"]: one["reason"] for one in listed if one["reason"]}
    assert said.keys() == case.said.keys()
    assert all(words in said[topic] for topic, words in case.said.items())


# What a config means

CONFIG = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: R, Enabled: true,
       Description Topic: {Value: %s}}
    - {Class: rviz_default_plugins/Grid, Name: G, Enabled: true,
       Reference Frame: base_link}
  Global Options: {Fixed Frame: %s}
"""


@pytest.mark.parametrize(
    ("topic", "fixed", "meant"),
    [
        ("/a/robot_description", "odom", "a/odom"),
        ("/b/robot_description", "odom", "b/odom"),
        ("/b/robot_description", "map", "map"),
        ("/b/robot_description", "a/odom", "a/odom"),
        ("/c/robot_description", "odom", ""),
    ],
)
def test_a_config_means_the_frames_of_its_robot(
    recording: Path, tmp_path: Path, topic: str, fixed: str, meant: str
) -> None:
    config = tmp_path / "one.rviz"
    config.write_text(CONFIG % (topic, fixed))
    with Visualizer(recording, config=config, port=0) as viz:
        scene = session_of(viz).scene
        status = scene.global_status()
        if meant:
            assert (status.level, scene.context.fixed_frame) == ("Ok", meant)
            robot = "a" if topic < B else "b"
            assert scene.context.frame("base_link") == f"{robot}/base_link"
        else:
            assert status.text == (
                "Frame [odom] does not exist: each robot has one, choose a/odom or "
                "b/odom"
            )
        # The config is written as it was read.
        saved = session_of(viz).document.config.to_yaml()
        assert f"Fixed Frame: {fixed}" in saved
