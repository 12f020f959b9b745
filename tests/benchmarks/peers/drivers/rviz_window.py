"""The real RViz of ROS 1 with robot_state_publisher, from Debian's packages.

It has a window and no page: it draws into the memory of a virtual screen, which is
looked at here. Runs with Debian's own Python, which has rospy.
"""

from __future__ import annotations

import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from speak import Moved, free_port, model_argument, obey

SCREEN = (1280, 720)
CLOSE = 40
ENOUGH = 160
"""So many pixels are the robot; the browsers' pictures have a sixteenth of them."""
CONFIG = """Visualization Manager:
  Class: ""
  Displays:
    - {Class: rviz/Grid, Name: Grid, Enabled: true, Value: true}
    - {Class: rviz/RobotModel, Name: RobotModel, Enabled: true, Value: true,
       Robot Description: robot_description}
  Global Options: {Fixed Frame: ROOT, Frame Rate: 30}
  Enabled: true
"""


class Screen:
    """What Xvfb keeps of its screen in a file."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def picture(self) -> np.ndarray:
        """Colours of all pixels, (rows, columns, 3), 0 to 255: red, green, blue."""
        data = self._path.read_bytes()
        head = struct.unpack(">25I", data[:100])
        rows, line, colours = head[5], head[12], head[19]
        start = head[0] + 12 * colours
        table = np.frombuffer(data[start : start + rows * line], np.uint8)
        return table.reshape(rows, line // 4, 4)[..., 2::-1].astype(np.int16)

    def shows_robot(self) -> bool:
        """Whether the robot's colour, cyan or magenta, is seen."""
        red, green, blue = np.moveaxis(self.picture(), 2, 0)
        cyan = np.minimum(green, blue) - red > CLOSE
        magenta = np.minimum(red, blue) - green > CLOSE
        return bool(max(cyan.sum(), magenta.sum()) >= ENOUGH)


def until(condition: object, longest: float) -> None:
    """Ask again and again until a call is true.

    Raises:
        TimeoutError: it did not become true in `longest` seconds.
    """
    end = time.monotonic() + longest
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError("no pixel of the robot's colour is seen")
        time.sleep(0.005)


home = tempfile.TemporaryDirectory()
port = free_port()
display = f":{port}"
os.environ.update(
    ROS_MASTER_URI=f"http://127.0.0.1:{port}",
    ROS_IP="127.0.0.1",
    ROS_HOME=home.name,
    HOME=home.name,
    DISPLAY=display,
    LIBGL_ALWAYS_SOFTWARE="1",
    QT_X11_NO_MITSHM="1",
)
children = []


def start(*words: str) -> None:
    """Start a program of RViz's company."""
    children.append(
        subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    )


width, height = SCREEN
start("Xvfb", display, "-screen", "0", f"{width}x{height}x24", "-fbdir", home.name)
start("roscore", "-p", str(port))
try:
    import rospy
    from sensor_msgs.msg import JointState

    text = Path(model_argument()).read_text("utf-8")
    root = "l0" if "tree" in text or "meshes" in text else "base_link"
    folder = Path(model_argument()).parent
    text = text.replace('filename="', f'filename="file://{folder}/')
    config = Path(home.name) / "robot.rviz"
    config.write_text(CONFIG.replace("ROOT", root), "utf-8")

    def has_master() -> bool:
        try:
            rospy.set_param("/robot_description", text)
        except OSError:
            return False
        return True

    until(has_master, 30.0)
    start("/usr/lib/robot_state_publisher/robot_state_publisher")
    start("rviz", "-d", str(config))
    rospy.init_node("driver", disable_signals=True)
    publisher = rospy.Publisher("/joint_states", JointState, queue_size=1)
    names = [
        part.split('"')[1]
        for part in text.split("<joint ")[1:]
        if 'type="fixed"' not in part.partition(">")[0]
    ]
    positions = dict.fromkeys(names, 0.0)

    def move(moved: list[str], q: float) -> None:
        """Publish the positions of all joints, as joint_state_publisher does."""
        positions.update(dict.fromkeys(moved, q))
        message = JointState(name=names, position=list(positions.values()))
        message.header.stamp = rospy.Time.now()
        publisher.publish(message)

    screen = Screen(Path(home.name) / "Xvfb_screen0")

    def robot_at() -> float:
        """When the robot is seen; its joints are published until then."""

        def shows() -> bool:
            move([], 0.0)
            return screen.shows_robot()

        until(shows, 60.0)
        return time.time()

    def changed(step: Moved) -> float:
        """How long a step takes until the picture is another."""
        before = screen.picture()
        step()
        began = time.perf_counter()
        until(lambda: not np.array_equal(before, screen.picture()), 20.0)
        return time.perf_counter() - began

    obey("", names, move, robot_at=robot_at, changed=changed)
finally:
    for child in reversed(children):
        child.terminate()
    for child in children:
        child.wait(10)
    home.cleanup()
    sys.stdout.flush()
