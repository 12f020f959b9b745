"""What commands answer, in all documents but the tutorial.

Each command that a document shows with its answer is run in a folder of its own, with
the files that `PREPARED` makes for it. A line of … stands for the rest of an answer.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from made_recording import (
    START,
    Message,
    header,
    store_of_all,
    transforms_message,
    write_messages,
)

from docs_parts.first_robot import agrees, output_of

ROOT = Path(__file__).resolve().parents[3]
SAM_BOT = ROOT / "assets" / "sam_bot.urdf.xacro"
LESSONS = ROOT / "tests" / "data" / "lessons"
_BLOCK = re.compile(r"^```(?:console|text)\n(?P<body>(?:(?!```).*\n)*)```$", re.M)
_COMMAND = re.compile(r"^\$ (?P<command>.*)\n(?P<said>(?:(?!\$ ).*\n)*)", re.M)


def nothing(folder: Path) -> None:
    """Need no file."""


def closed_too_early() -> str:
    """Return a model with the mistake of many beginners: no link is in its robot."""
    first, rest = SAM_BOT.read_text("utf-8").split("<xacro:property", 1)
    return f"{first}</robot>\n  <xacro:property{rest}"


def a_robot_closed_too_early(folder: Path) -> None:
    """Write that model."""
    (folder / "my_robot.urdf.xacro").write_text(closed_too_early(), "utf-8")


def a_package_with_a_mirrored_wheel(folder: Path) -> None:
    """Write the solution of the tutorial's lesson with one sign wrong."""
    shutil.copytree(
        LESSONS / "nav2-first-robot" / "sam_bot_description", folder / "my_package"
    )
    (model,) = (folder / "my_package").rglob("*.urdf")
    text = model.read_text("utf-8").replace('y_reflect="-1"', 'y_reflect="1"')
    model.write_text(text, "utf-8")


def a_lesson_with_a_wheel_too_far_back(folder: Path) -> None:
    """Write a lesson of two steps, and a model that passes the first."""
    shutil.copytree(LESSONS / "base", folder / "my-lesson")
    text = SAM_BOT.read_text("utf-8").replace('xoff" value="0.12"', 'xoff" value="0.2"')
    (folder / "robot.urdf.xacro").write_text(text, "utf-8")


def a_recording_without_static_frames(folder: Path) -> None:
    """Write six seconds of a robot whose /tf_static nobody has recorded."""
    store = store_of_all()
    joints = store.types["sensor_msgs/msg/JointState"]
    scan = store.types["sensor_msgs/msg/LaserScan"]
    none, ray = np.array([]), np.array([1.0], dtype=np.float32)

    def joint_state(seconds: float) -> Any:
        name, position = ["drivewhl_l_joint"], np.array([seconds])
        return joints(header(store, seconds, ""), name, position, none, none)

    def laser_scan(seconds: float) -> Any:
        numbers = (0.0, 0.0, 0.1, 0.0, 0.0, 0.1, 10.0)
        return scan(header(store, seconds, "lidar_link"), *numbers, ray, ray)

    def transforms(seconds: float) -> Any:
        return transforms_message(store, seconds, {"base_link": "odom"})

    def messages() -> Iterator[Message]:
        for topic, kind, rate, made in (
            ("/tf", "tf2_msgs/msg/TFMessage", 50, transforms),
            ("/joint_states", "sensor_msgs/msg/JointState", 20, joint_state),
            ("/scan", "sensor_msgs/msg/LaserScan", 5, laser_scan),
        ):
            for number in range(6 * rate):
                seconds = number / rate
                time = START * 10**9 + round(seconds * 1e9)
                yield topic, kind, time, made(seconds)

    ordered = sorted(messages(), key=lambda message: message[2])
    write_messages(folder / "yesterday.mcap", ordered)


PREPARED: Mapping[str, Mapping[str, Callable[[Path], None]]] = {
    "README.md": {"sambot-viz check my_robot.urdf.xacro": a_robot_closed_too_early},
    "docs/guide.md": {
        "sambot-viz echo base_link base_laser "
        '--static-transform "0.1 0 0.2 0 0 0 base_link base_laser"': nothing,
        "sambot-viz topics yesterday.mcap": a_recording_without_static_frames,
    },
    "docs/lessons.md": {
        "sambot-viz grade my_package --lesson nav2-first-robot --step wheels": (
            a_package_with_a_mirrored_wheel
        ),
        "sambot-viz grade robot.urdf.xacro --lesson my-lesson --format json": (
            a_lesson_with_a_wheel_too_far_back
        ),
    },
}
"""Document → command as it is written there → what makes its files.

The document has the answer of each, once.
"""


def refreshed(name: str, document: str) -> str:
    """Return a document with the answers of now.

    Args:
        name: of the document; it need not be in `PREPARED`.
        document: its text.

    Raises:
        ValueError: it has an answer whose command is not in `PREPARED`, or no place
            for one that is.
    """
    prepared = PREPARED.get(name, {})
    shown = list(_commands(document))
    places = {start: command for command, start, end in shown if end > start}
    for command in prepared.keys() - places.values():
        empty = [start for one, start, _ in shown if one == command]
        if not empty:
            raise ValueError(f"{name} has no block with {command!r}")
        places[empty[-1]] = command
    pieces, end = list[str](), 0
    for command, start, after in shown:
        if start in places:
            if command not in prepared:
                raise ValueError(f"nothing runs {command!r}: add it to quotes.PREPARED")
            said = document[start:after]
            now = _answer(command, prepared[command])
            pieces += [document[end:start], said if said and agrees(said, now) else now]
            end = after
    return "".join([*pieces, document[end:]])


def _commands(document: str) -> Iterator[tuple[str, int, int]]:
    """Yield each command in a block, with the place of its answer in the document."""
    for block in _BLOCK.finditer(document):
        for found in _COMMAND.finditer(document, *block.span("body")):
            yield found["command"], *found.span("said")


def _answer(command: str, prepare: Callable[[Path], None]) -> str:
    with tempfile.TemporaryDirectory() as folder:
        prepare(Path(folder))
        now = output_of(Path(folder), command)
    return now if now.endswith("\n") else f"{now}\n"
