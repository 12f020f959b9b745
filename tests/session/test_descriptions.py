"""RobotModel shows the robot of the topic that it names."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from inside import session_of
from live_peers import FoxglovePeer, eventually
from made_recording import described, write_recording

from sambot_viz import Visualizer
from sambot_viz.displays.display import Status
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.panels.problems.status_rows import status_rows
from sambot_viz.session import Session

MAIN, OTHER = "/robot_description", "/other/robot_description"
TOPIC = "Description Topic"
MOVES = [("/tf", 0.0, {"a_base": "odom", "a_arm": "a_base", "b_base": "odom"})]
CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Name: One
      Enabled: true
      Description Topic: {Value: %s}
    - Class: rviz_default_plugins/RobotModel
      Name: Two
      Enabled: true
      Description Topic: {Value: %s}
  Global Options: {Fixed Frame: odom}
"""


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    return write_recording(
        tmp_path / "two.mcap",
        {
            MAIN: described("a_base", "a_arm"),
            OTHER: described("b_base", "b_arm"),
            "/urdf": described("c_base"),
            "/notes": "it drove well",
            "/file": "/etc/passwd",
        },
        MOVES,
        {"/scan": "sensor_msgs/msg/LaserScan", "/never": "std_msgs/msg/String"},
    )


@pytest.fixture
def viz(recording: Path) -> Iterator[Visualizer]:
    with Visualizer(recording, port=0) as viz:
        yield viz


def models(session: Session) -> list[RobotModelDisplay]:
    return [d for d in session.scene.displays if isinstance(d, RobotModelDisplay)]


def links(display: RobotModelDisplay) -> list[str]:
    return [] if not display.entries() else sorted(display.entries()[0].names)


def say(display: RobotModelDisplay, key: str = "Topic") -> str:
    return display.status.rows[key].text


def name_topic(viz: Visualizer, topic: str) -> RobotModelDisplay:
    session = session_of(viz)
    display, *_ = models(session)
    with session.history.acting(1):
        session.display_edits.set_property(display, TOPIC, topic)
    return display


def test_the_robot_of_the_topic_is_shown_and_undo_brings_the_other_back(
    viz: Visualizer,
) -> None:
    display, *_ = models(session_of(viz))
    assert links(display) == ["a_arm", "a_base"]
    name_topic(viz, OTHER)
    eventually(lambda: links(display) == ["b_arm", "b_base"])
    # The links are there before the statuses.
    eventually(lambda: say(display) == "OK")
    eventually(lambda: say(display, "b_base") == "Transform OK")
    assert session_of(viz).robot.model.name == "a_base"
    session = session_of(viz)
    session.history.undo(1)
    assert links(display) == ["a_arm", "a_base"]
    session.history.redo(1)
    eventually(lambda: links(display) == ["b_arm", "b_base"])
    assert f"Value: {OTHER}" in session.document.config.to_yaml()


def test_any_topic_of_texts_may_describe_a_robot(viz: Visualizer) -> None:
    display = name_topic(viz, "urdf")
    eventually(lambda: links(display) == ["c_base"])


@pytest.mark.parametrize(
    ("topic", "key", "says"),
    [
        (
            "/othr/robot_description",
            "Topic",
            f"There is no topic /othr/robot_description; did you mean '{OTHER}'?",
        ),
        ("/scan", "Topic", "this is sensor_msgs/msg/LaserScan: choose another topic"),
        ("/never", "Topic", "No message was recorded"),
        ("/notes", "URDF", "URDF failed Model parse: this is not XML"),
        ("/file", "URDF", "URDF failed Model parse: this is not XML"),
    ],
)
def test_the_status_says_why_there_is_no_robot_and_the_last_one_stays(
    viz: Visualizer, topic: str, key: str, says: str
) -> None:
    display = name_topic(viz, OTHER)
    eventually(lambda: links(display) == ["b_arm", "b_base"])
    name_topic(viz, topic)
    eventually(lambda: says in say(display, key))
    assert display.status.level == "Error"
    assert links(display) == ["b_arm", "b_base"]
    name_topic(viz, MAIN)
    eventually(lambda: display.status.level == "Ok")
    assert links(display) == ["a_arm", "a_base"]


def test_a_button_takes_the_topic_that_was_meant(viz: Visualizer) -> None:
    display = name_topic(viz, "/othr/robot_description")
    scene = session_of(viz).scene
    rows = status_rows(display, "d0/:status", "d0", scene, [], [], all_rows=True)
    buttons = [row.extra["repair"] for row in rows if row.name == "Topic" and row.extra]
    assert buttons == [[f"Use {OTHER}", f"d0/{TOPIC}", OTHER]]


def test_two_displays_show_two_robots_and_the_first_one_is_moved(
    recording: Path, tmp_path: Path
) -> None:
    config = tmp_path / "two.rviz"
    config.write_text(CONFIG % (OTHER, MAIN))
    with Visualizer(recording, config=config, port=0) as viz:
        one, two = models(session_of(viz))
        eventually(lambda: links(one) == ["b_arm", "b_base"])
        eventually(lambda: links(two) == ["a_arm", "a_base"])
        # The joints are those of the robot that the config names first.
        assert session_of(viz).robot.model.name == "b_base"
        for display in (one, two):
            eventually(lambda display=display: display.status.level == "Ok")


def test_a_model_beside_a_recording_takes_the_place_of_its_robot(
    recording: Path, tmp_path: Path
) -> None:
    model = tmp_path / "own.urdf"
    model.write_text(described("own"))
    with Visualizer(model, source=f"bag:{recording}", port=0) as viz:
        display, *_ = models(session_of(viz))
        assert links(display) == ["own"]
        name_topic(viz, "/othr/robot_description")
        assert "did you mean" in say(display)
        assert links(display) == ["own"]
        name_topic(viz, OTHER)
        eventually(lambda: links(display) == ["b_arm", "b_base"])


def test_a_robot_in_a_namespace_needs_no_config(tmp_path: Path) -> None:
    texts = {"/r1/robot_description": described("a_base", "a_arm")}
    path = write_recording(tmp_path / "one.mcap", texts, MOVES)
    with Visualizer(path, port=0) as viz:
        display, *_ = models(session_of(viz))
        assert links(display) == ["a_arm", "a_base"]
        assert display.config.get(TOPIC) == "/r1/robot_description"


def test_without_a_robot_it_is_said_how_to_give_one(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "none.mcap", {}, MOVES)
    with Visualizer(path, port=0) as viz:
        session = session_of(viz)
        said = {one.code: one for one in session.problems.shown.value.listed}
        assert "no robot model in none.mcap" in said["no-description"].message
        assert said["no-description"].hint == "add --model ROBOT.urdf.xacro"
        # Who wants one all the same reads it at the display.
        display, *_ = models(session)
        assert not display.shown
        session.display_edits.set_enabled(display, True)
        assert "no robot model in none.mcap" in say(display)


@pytest.fixture
def peer() -> Iterator[FoxglovePeer]:
    peer = FoxglovePeer()
    yield peer
    peer.stop()


def test_a_live_robot_is_that_of_the_topic_as_soon_as_it_is_described(
    peer: FoxglovePeer,
) -> None:
    peer.advertise(MAIN, latched=True)
    peer.publish(MAIN, described("a_base", "a_arm"))
    with Visualizer(source=peer.uri, port=0) as viz:
        display, *_ = models(session_of(viz))
        eventually(lambda: links(display) == ["a_arm", "a_base"])
        name_topic(viz, OTHER)
        assert f"There is no topic {OTHER}" in say(display)
        assert links(display) == ["a_arm", "a_base"]
        peer.advertise(OTHER, latched=True)
        eventually(lambda: "No message yet" in say(display))
        peer.publish(OTHER, described("b_base", "b_arm"))
        eventually(lambda: links(display) == ["b_arm", "b_base"])
        # Nothing says where the one is beside the other.
        eventually(lambda: 'static-transform "0 0 0 0 0 0 a_base' in say(display))
        peer.publish(OTHER, "no robot")
        eventually(lambda: "this is not XML" in say(display, "URDF"))
        assert links(display) == ["b_arm", "b_base"]
        peer.publish(OTHER, described("b_base", "b_hand"))
        eventually(lambda: links(display) == ["b_base", "b_hand"])
        eventually(lambda: display.status.rows["URDF"].level == "Ok")


def test_a_live_robot_whose_description_cannot_be_shown_is_said(
    peer: FoxglovePeer,
) -> None:
    peer.advertise(MAIN, latched=True)
    peer.publish(MAIN, "/etc/passwd")
    with Visualizer(source=peer.uri, port=0) as viz:
        display, *_ = models(session_of(viz))
        eventually(lambda: "URDF failed Model parse: this is not XML" in say(display))
        peer.publish(MAIN, described("a_base"))
        eventually(lambda: display.status.level == "Ok" and links(display))


def test_a_qos_that_cannot_match_is_said_with_both_words(peer: FoxglovePeer) -> None:
    best_effort = "- reliability: best_effort\n  durability: volatile\n"
    peer.advertise(MAIN, latched=True, qos=best_effort)
    tf = "tf2_msgs/msg/TFMessage"
    peer.advertise("/tf", schema=tf, qos=best_effort)
    peer.advertise("/tf_static", schema=tf, qos="- durability: volatile\n")
    with Visualizer(source=peer.uri, port=0) as viz:
        display, *_ = models(session_of(viz))
        wants = "A publisher offers Best Effort, the display wants Reliable: set its"
        eventually(lambda: wants in say(display))
        assert display.status.rows["Topic"].level == "Warn"
        frames = next(
            d for d in session_of(viz).scene.displays if d.kind.endswith("/TF")
        )
        said = Status(
            "Warn",
            "A publisher offers Best Effort, tf2 wants Reliable; RViz and other nodes "
            "get nothing from it: change its QoS",
            "qos",
        )
        eventually(lambda: frames.status.rows["/tf"] == said)
        static = "tf2 wants Transient Local"
        eventually(lambda: static in frames.status.rows["/tf_static"].text)
        policy = f"{TOPIC}/Reliability Policy"
        session_of(viz).display_edits.set_property(display, policy, "Best Effort")
        eventually(lambda: wants not in say(display))
        peer.publish(MAIN, described("a_base"))
        eventually(lambda: say(display) == "OK" and links(display) == ["a_base"])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("hello", "URDF failed Model parse: this is not XML"),
        (
            '<robot name="two"><link name="a"/><link name="b"/></robot>',
            "URDF failed Model parse: link b is not connected to a",
        ),
    ],
)
def test_frames_are_shown_without_a_robot_that_cannot_be(
    tmp_path: Path, text: str, says: str
) -> None:
    path = write_recording(tmp_path / "bad.mcap", {MAIN: text}, MOVES)
    with Visualizer(path, port=0) as viz:
        display, *_ = models(session_of(viz))
        eventually(lambda: says in say(display))
        assert display.status.level == "Error"
        at = viz.frames.lookup("odom", "a_arm").translation
        assert at.tolist() == pytest.approx([0.0, 0.0, 0.0])
        listed = session_of(viz).problems.shown.value.listed
        assert any(problem.severity == "error" for problem in listed)
