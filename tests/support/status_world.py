"""Opens a recording in which the situations of RViz's statuses come about, all at once.

Each situation has a display and a topic of its own, so that one recording is enough for
all that have the same transforms and the same fixed frame.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from unittest import mock

import yaml
from blank_messages import blank_message
from inside import session_of
from made_recording import Message, described, write_messages
from patience import patience
from protocol_client import wait_for_workers
from situations import START_NS, TYPES, display_of, message_of
from visible_steps import steps_to

from sambot_viz.displays.robot_display import ModelRequest
from sambot_viz.panels import row_sync
from sambot_viz.server.model_thread import ModelThread

FIRST_S, END_S = 0.5, 8.0
"""When messages begin to come, and when the recording ends [s]."""
EVERY_S = 0.2
"""The time between two messages of a topic, and between two pictures [s]."""
Rows = dict[str, tuple[str, str]]
"""Key of a status → level and text."""
_LINKS = "base_footprint base_link drivewhl_l_link drivewhl_r_link front_caster".split()


@dataclass(frozen=True, slots=True)
class World:
    """What is around some situations.

    Attributes:
        situations: their names.
        count: so many messages are sent in each.
        has_tf: whether there are transforms.
        fixed_frame: as is set.
    """

    situations: Sequence[str]
    count: int = 1
    has_tf: bool = True
    fixed_frame: str = "map"


def statuses_in(world: World, folder: Path) -> Mapping[str, Rows]:
    """Return the statuses of each situation, and of "Fixed Frame", at the end.

    Args:
        world: the situations.
        folder: where the files are written.
    """
    from sambot_viz import Visualizer

    source, config = files_of(world, folder)
    with (
        _held_back() as read,
        # No page is there for which rows of panels are to be made at each step.
        mock.patch.object(row_sync, "PERIOD", 3600.0),
        Visualizer(source=f"bag:{source}", config=config, port=0) as viz,
    ):
        for _ in steps_to(viz, END_S, EVERY_S):
            read()
        session = session_of(viz)
        found = {
            display.config.name: {
                key: (row.level, row.text) for key, row in display.status.rows.items()
            }
            for display in session.scene.displays
        }
        fixed = session.scene.global_status()
        return {**found, "": {"Fixed Frame": (fixed.level, fixed.text)}}


@contextmanager
def _held_back() -> Iterator[Callable[[], None]]:
    """Yield what reads the models that displays have asked for, and returns then.

    A thread reads them otherwise, so that it depends on the machine what a robot of a
    topic finds when it comes.
    """
    asked: list[Callable[[], None]] = []
    begin = ModelThread.read

    def hold(thread: ModelThread, request: ModelRequest) -> None:
        asked.append(partial(begin, thread, request))
        threads.add(thread)

    def read() -> None:
        if asked:
            while asked:
                asked.pop(0)()
            assert all(thread.wait(patience(20.0)) for thread in threads)
            wait_for_workers()

    threads: set[ModelThread] = set()
    with mock.patch.object(ModelThread, "read", hold):
        yield read


def files_of(world: World, folder: Path) -> tuple[Path, Path]:
    """Return a recording of some situations, and a config with their displays.

    Args:
        world: the situations.
        folder: where the files are written.
    """
    source = _write(world, folder / "messages.mcap")
    shown = [_shown(one) for one in world.situations]
    options = {"Fixed Frame": world.fixed_frame}
    manager = {"Class": "", "Displays": shown, "Global Options": options}
    config = folder / "displays.rviz"
    config.write_text(yaml.safe_dump({"Visualization Manager": manager}))
    return source, config


def _topic(situation: str) -> str:
    return f"/{situation.replace('.', '/')}"


def _shown(situation: str) -> Mapping[str, object]:
    """Return the display of a situation, as in a file."""
    what, kind = situation.partition(".")[0], display_of(situation)
    topic = "" if what == "emptytopic" else _topic(situation)
    values: dict[str, object] = {"Topic": {"Value": topic}}
    if kind in ("Grid", "Axes"):
        frame = "base_link" if what == "ok" else "no_such_frame"
        values = {"Reference Frame": frame}
    elif kind == "RobotModel":
        values = {
            "Description Source": "Topic",
            "Description Topic": {"Value": topic},
        }
    elif kind == "TF":
        values = {}
    return {
        "Class": f"rviz_default_plugins/{kind}",
        "Name": situation,
        "Enabled": True,
        **values,
    }


def _write(world: World, path: Path) -> Path:
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    messages = transforms(store, END_S) if world.has_tf else []
    empty: dict[str, str] = {}
    for situation in world.situations:
        what, kind = situation.partition(".")[0], display_of(situation)
        name = "nav_msgs/msg/Path" if what == "wrongtype" else TYPES.get(kind)
        if what == "none" and name is not None:
            empty[_topic(situation)] = name
        for number in range(world.count):
            time = START_NS + round((FIRST_S + number * EVERY_S) * 1e9)
            message = message_of(store, situation, time)
            if message is not None and name is not None:
                messages.append((_topic(situation), name, time, message))
    text = "std_msgs/msg/String"
    urdf = {"/notf/RobotModel": described(*_LINKS), "/badxml/RobotModel": "<robot"}
    for topic, content in urdf.items():
        if topic[1:].replace("/", ".") in world.situations:
            messages.append((topic, text, START_NS, store.types[text](content)))
    for seconds in (0.0, END_S):
        # The recording is so long whatever else is sent.
        time = START_NS + round(seconds * 1e9)
        messages.append(("/begin_and_end", text, time, store.types[text]("")))
    return write_messages(path, sorted(messages, key=lambda one: one[2]), empty)


def transforms(store: Any, end_s: float, *, begin_s: float = 0.0) -> list[Message]:
    """Return map → odom → base_link at 10 Hz, and static transforms.

    Args:
        store: of rosbags.
        end_s: the time of the last one [s].
        begin_s: the time of the first one [s].
    """
    static = {"laser": "base_link", "island_b": "island"}
    name, begin = "tf2_msgs/msg/TFMessage", START_NS + round(begin_s * 1e9)
    made = [("/tf_static", name, begin, _sent(store, begin, static))]
    for number in range(round((end_s - begin_s) * 10)):
        time = begin + number * 10**8
        moved = _sent(store, time, {"odom": "map", "base_link": "odom"})
        made.append(("/tf", name, time, moved))
    return made


def _sent(store: Any, time_ns: int, frames: Mapping[str, str]) -> object:
    message = blank_message(store, "tf2_msgs/msg/TFMessage")
    for child, parent in frames.items():
        one = blank_message(store, "geometry_msgs/msg/TransformStamped")
        one.header.frame_id, one.child_frame_id = parent, child
        one.header.stamp.sec, one.header.stamp.nanosec = divmod(time_ns, 10**9)
        message.transforms.append(one)
    return message
