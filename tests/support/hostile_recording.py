"""A recording of hostile messages for every display, and a config that shows all.

Each display is there twice: once it gets hostile messages and then a good one, once the
good one alone.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml
from blank_messages import blank_message
from extreme_messages import extreme_message
from made_recording import Message, described, store_of_all, write_messages
from situations import START_NS, TYPES, good_message, headed

from sambot_viz.displays.data.topic_display import TopicDisplay
from sambot_viz.displays.registry import DISPLAYS
from sambot_viz.rviz import BoolProperty, EnumProperty

MESSAGES = 60
"""So many hostile messages come to each display, then a good one."""
VARIANTS = 2
"""So many displays of each kind are tried, each with other settings."""
STEP_S = 0.1
"""The time between two messages of a topic [s]."""
FULL = "update_full"


@dataclass(frozen=True, slots=True)
class Tried:
    """A display and what it is sent.

    Attributes:
        kind: its class, such as "rviz_default_plugins/Pose".
        type_name: of the messages.
        number: of the variant.
        is_attacked: whether hostile messages come before the good one.
    """

    kind: str
    type_name: str
    number: int
    is_attacked: bool = True

    @property
    def name(self) -> str:
        """The name of the class alone."""
        return self.kind.rpartition("/")[2]

    @property
    def topic(self) -> str:
        name = self.type_name.rpartition("/")[2]
        what = "bad" if self.is_attacked else "fine"
        ends = {"InteractiveMarkerUpdate": "update", "InteractiveMarkerInit": FULL}
        return f"/{self.name}/{name}/v{self.number}/{what}/{ends.get(name, 'data')}"

    @property
    def shown(self) -> Mapping[str, object]:
        """The display as in a file, with settings that depend on the number."""
        display = DISPLAYS[self.kind]
        assert issubclass(display, TopicDisplay)
        of_topic = display.topic_values(self.topic, self.type_name, None)
        assert of_topic is not None
        chance = random.Random(f"{self.kind} {self.number}")
        values: dict[str, object] = {}
        for one in display.properties:
            if isinstance(one, EnumProperty) and one.options:
                values[one.name] = chance.choice(one.options)
            elif isinstance(one, BoolProperty) and not one.children:
                values[one.name] = chance.random() < 0.5
        return {
            "Class": self.kind,
            "Name": self.topic,
            "Enabled": True,
            **values,
            **of_topic,
        }

    def messages(self, store: Any) -> Iterator[Message]:
        """Yield what it is sent."""
        for number in range(MESSAGES if self.is_attacked else 0):
            time = START_NS + round(number * STEP_S * 1e9)
            seed = hash_of(f"{self.topic} {number}")
            message = extreme_message(store, self.good(store), seed)
            data = broken(bytes(store.serialize_cdr(message, self.type_name)), seed)
            yield self.topic, self.type_name, time, data
        last = START_NS + round(MESSAGES * STEP_S * 1e9)
        yield self.topic, self.type_name, last, self.good(store)
        if self.name == "DepthCloud":
            info = f"{self.topic.rpartition('/')[0]}/camera_info"
            yield info, TYPES["CameraInfo"], START_NS, good_message(store, "CameraInfo")

    def good(self, store: Any) -> Any:
        """Return a message without a fault."""
        is_made = TYPES.get(self.name) == self.type_name
        made = good_message(store, self.name) if is_made else None
        message = made or blank_message(store, self.type_name)
        for one in headed(message):
            one.header.frame_id = "map"
        return message


def hash_of(text: str) -> int:
    """A number that is the same in each run."""
    return int.from_bytes(text.encode(), "big") % 1_000_003


def broken(data: bytes, seed: int) -> bytes:
    """Return bytes as they are, or each seventh time cut off or changed."""
    chance = random.Random(seed)
    if seed % 7:
        return data
    if seed % 2:
        return data[: chance.randrange(len(data))]
    changed = bytearray(data[:100_000])
    for _ in range(4):
        changed[chance.randrange(4, len(changed))] = chance.choice([0, 1, 127, 255])
    return bytes(changed)


def all_tried() -> Iterator[Tried]:
    for kind, display in DISPLAYS.items():
        if not issubclass(display, TopicDisplay):
            continue
        for type_name in sorted(one.value for one in display.meanings):
            for number in range(VARIANTS):
                for is_attacked in (True, False):
                    yield Tried(kind, type_name, number, is_attacked)


def write_hostile(folder: Path, tried: Sequence[Tried]) -> tuple[Path, Path]:
    """Write a recording and a config, and return their paths.

    Args:
        folder: where they are written.
        tried: the displays.
    """
    store = store_of_all()
    text = "std_msgs/msg/String"
    urdf = store.types[text](described("base", "tip"))
    messages: list[Message] = [("/robot_description", text, START_NS, urdf)]
    messages += [message for one in tried for message in one.messages(store)]
    messages.sort(key=lambda one: one[2])
    source = write_messages(folder / "messages.mcap", messages)
    manager = {
        "Class": "",
        "Displays": [dict(one.shown) for one in tried],
        "Global Options": {"Fixed Frame": "map"},
    }
    config = folder / "displays.rviz"
    config.write_text(yaml.safe_dump({"Visualization Manager": manager}))
    return source, config
