"""A real rosbridge with real ROS 2 behind it, from packages of PyPI.

`SAMBOT_VIZ_ROS` names a folder with two environments: `venv-jazzy`, made by
``DISTRO=jazzy TF2=0 bash ../shared/tools/ros/00_make_ros_venv.sh ./venv-jazzy`` there,
and `venv-ws` with the package rosbridge-server-rs. Together they have 300 MB.
"""

from __future__ import annotations

import os
import random
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from live_peers import WAIT, Inbox, free_port
from patience import until

from sambot_viz.messages import MessageTypes
from sambot_viz.sources.source import Source

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
