"""A robot of real ROS 2 with Fast DDS, from packages of PyPI, over DDS.

`SAMBOT_VIZ_ROS` names a folder with an environment of Python 3.11 for each of two
distributions, `venv-jazzy` and `venv-kilted`. nightly.yml says what pip installs into
them; together they have 550 MB.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from live_peers import WAIT, Inbox, eventually
from rosbags.typesys import Stores, get_typestore

from sambot_viz.messages import MessageTypes
from sambot_viz.publishing.parameters import get_parameters, set_parameter
from sambot_viz.sources.action_names import status_topic
from sambot_viz.sources.message import Recorded
from sambot_viz.sources.source import GoalReport, OutgoingAction, Reply, Source

# The same with a peer of our own: test_dds.py and test_conformance.py.
pytestmark = pytest.mark.slow

Open = Callable[[str], Source]
ROBOT = """
import json
import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.action import ActionServer
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import JointState, LaserScan
from std_msgs.msg import String
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci
from test_msgs.msg import BasicTypes

rclpy.init()
node = rclpy.create_node("robot", namespace="/lab")
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
description = node.create_publisher(String, "/robot_description", latched)
description.publish(String(data="<robot/>"))
joints = node.create_publisher(JointState, "/joint_states", 10)
scan = node.create_publisher(LaserScan, "/scan", qos_profile_sensor_data)
own = node.create_publisher(BasicTypes, "/own", latched)
own.publish(BasicTypes(int32_value=7))
node.declare_parameter("speed", 0.5)

def say(of, **what):
    print(json.dumps({"of": of, **what}), flush=True)

def move():
    stamp = node.get_clock().now().to_msg()
    message = JointState(name=["wheel"], position=[0.5])
    message.header.stamp = stamp
    joints.publish(message)
    scan.publish(LaserScan(ranges=[1.0, 2.0]))

def power(request, response):
    response.success, response.message = request.data, "done"
    return response

def count(handle):
    order = handle.request.order
    handle.publish_feedback(Fibonacci.Feedback(sequence=[0, order]))
    handle.succeed()
    return Fibonacci.Result(sequence=[order])

node.create_timer(0.02, move)
take = lambda goal: say("goal", frame=goal.header.frame_id, x=goal.pose.position.x)
node.create_subscription(PoseStamped, "/goal_pose", take, 10)
node.create_service(SetBool, "~/power", power)
server = ActionServer(node, Fibonacci, "/count", count)
say("ready")
rclpy.spin(node)
"""
ACTION, KIND = "/count", "test_msgs/action/Fibonacci"


class Robot:
    """The program of the robot, which says in lines of JSON what comes to it."""

    def __init__(self, python: Path, domain: int) -> None:
        self.said: list[dict[str, Any]] = []
        own = {
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
        }
        self._process = subprocess.Popen(
            [str(python), "-c", ROBOT],
            env={**os.environ, **own},
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        eventually(lambda: self.of("ready"))

    def of(self, kind: str) -> list[dict[str, Any]]:
        return [one for one in list(self.said) if one["of"] == kind]

    def kill(self) -> None:
        """End it at once: it tells nobody that it goes."""
        self._process.kill()
        self._process.wait(WAIT)
        self._reader.join()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            self.said.extend(map(json.loads, lines))


@pytest.fixture(params=["jazzy", "kilted"])
def python(request: pytest.FixtureRequest) -> Path:
    folder = Path(os.environ.get("SAMBOT_VIZ_ROS", ""))
    found = folder / f"venv-{request.param}" / "bin" / "python"
    if not found.exists():
        pytest.skip(f"needs ROS 2 {request.param} in the folder SAMBOT_VIZ_ROS")
    return found


@pytest.fixture
def domain() -> int:
    return random.randint(1, 100)


@pytest.fixture
def robot(python: Path, domain: int) -> Iterator[Robot]:
    made = Robot(python, domain)
    yield made
    made.kill()


@pytest.fixture
def source(robot: Robot, opened: Open, domain: int) -> Source:
    made = opened(f"dds:?domain={domain}&interface=lo&peer=127.0.0.1")
    eventually(lambda: made.topics()["/scan"].publishers == ("/lab/robot",))
    return made


def decoded(message: Recorded) -> Any:
    return MessageTypes().decoder(message.channel.schema, "cdr").decode(message.payload)


def test_topics_of_all_kinds_of_qos_are_seen_with_their_node(source: Source) -> None:
    inboxes = {one: Inbox() for one in ("/robot_description", "/joint_states", "/scan")}
    for topic, inbox in inboxes.items():
        source.subscribe(topic, inbox)
    eventually(lambda: all(inbox.messages for inbox in inboxes.values()))
    assert decoded(inboxes["/robot_description"].messages[0]).data == "<robot/>"
    assert [*decoded(inboxes["/joint_states"].messages[0]).position] == [0.5]
    assert [*decoded(inboxes["/scan"].messages[0]).ranges] == [1.0, 2.0]
    topics = source.topics()
    published = [one for one in topics.values() if not one.is_awaited]
    assert {one.publishers for one in published} == {("/lab/robot",)}
    assert topics["/goal_pose"].is_awaited
    assert topics["/goal_pose"].subscribers == ("/lab/robot",)
    qos = topics["/robot_description"].qos, topics["/scan"].qos
    assert qos[0] is not None and qos[0].durability == "transient_local"
    assert qos[1] is not None and qos[1].reliability == "best_effort"


def test_the_node_is_asked_for_a_type_of_its_own(source: Source) -> None:
    inbox = Inbox()
    source.subscribe("/own", inbox)
    eventually(lambda: decoded(inbox.messages[-1]).int32_value == 7)


def test_a_goal_arrives(robot: Robot, source: Source) -> None:
    kind = "geometry_msgs/msg/PoseStamped"
    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    stamp = types["builtin_interfaces/msg/Time"](0, 0)
    place = types["geometry_msgs/msg/Point"](3.0, 2.0, 0.0)
    turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    header = types["std_msgs/msg/Header"](stamp, "map")
    goal = types[kind](header, types["geometry_msgs/msg/Pose"](place, turn))
    outgoing = source.advertise("/goal_pose", kind)
    outgoing.send(bytes(store.serialize_cdr(goal, kind)))
    eventually(lambda: robot.of("goal") == [{"of": "goal", "frame": "map", "x": 3.0}])
    eventually(lambda: outgoing.receivers.names == ("/lab/robot",))


def test_services_and_parameters_answer(source: Source) -> None:
    replies: list[Reply] = []
    request = b"\0\1\0\0\1"
    for _ in range(3):
        source.call("/lab/robot/power", lambda encoding: request, replies.append)
    eventually(lambda: len(replies) == 3)
    assert all(b"done" in one.content for one in replies)
    types, said = MessageTypes(), list[Any]()
    set_parameter(source, "/lab/robot", "speed", 1.5, types, said.append)
    eventually(lambda: said == [""])
    take = lambda *found: said.append(found)  # noqa: E731
    get_parameters(source, "/lab/robot", ["speed"], types, take)
    eventually(lambda: said[-1] == ([1.5], ""))


def test_an_action_is_followed_to_its_end(source: Source) -> None:
    source.subscribe(status_topic(ACTION), lambda message: None)
    found: list[OutgoingAction] = []
    eventually(lambda: found.append(source.action(ACTION, KIND)) or True)
    told: list[GoalReport] = []
    found[-1].send(b"\0\1\0\0\5\0\0\0", told.append)
    eventually(lambda: told[-1].is_last)
    assert told[-1].status == 4
    assert any(one.feedback is not None for one in told)


def test_a_robot_that_was_killed_and_started_again_is_heard(
    python: Path, robot: Robot, source: Source, domain: int
) -> None:
    inbox = Inbox()
    source.subscribe("/robot_description", inbox)
    eventually(lambda: inbox.strings() == ["<robot/>"])
    robot.kill()
    again = Robot(python, domain)
    try:
        eventually(lambda: inbox.strings() == ["<robot/>"] * 2)
    finally:
        again.kill()
