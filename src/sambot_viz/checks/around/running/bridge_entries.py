"""Read the topics that a bridge between Gazebo and ROS carries."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.running.system import Endpoint
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, nearest

DIRECTIONS = ("GZ_TO_ROS", "ROS_TO_GZ", "BIDIRECTIONAL")
_TO_ROS, _TO_GZ, _BOTH = DIRECTIONS
TYPES = ("ros_type_name", "gz_type_name")
"""The keys for the types of a topic, without which the bridge leaves it out."""
_KEYS = (*TYPES, "topic_name", "ros_topic_name", "gz_topic_name", "direction")
_OTHER_KEYS = frozenset(
    """
    frame_id gz_rep_type_name gz_req_type_name gz_service_name lazy
    publish_optical_frame publisher_queue qos_profile ros_service_name
    ros_type_name service_name subscriber_queue type_name
    """.split()
)
_LIKENESS = 0.75
_ARROWS = {"[": _TO_ROS, "]": _TO_GZ, "@": _BOTH}
_BRIDGED = re.compile(r"(/?[\w/]+)@([\w/]+)([\[\]@])([\w.]+)")
IMAGE_BRIDGE = "image_bridge"
"""A bridge that carries only images: its arguments are topics."""
_NAME = re.compile(r"/?[\w/]+")
_SCOPED = ("world/", "model/")


class BridgeEntry(NamedTuple):
    """A topic that a bridge carries.

    Attributes:
        ros: its name in ROS.
        gz: its name in Gazebo.
        ros_type: its type in ROS.
        gz_type: its type in Gazebo, with the name of the package gz.msgs.
        direction: GZ_TO_ROS, ROS_TO_GZ or BIDIRECTIONAL.
        arrow: the sign for the direction in an argument; empty for a file.
    """

    ros: Fact
    gz: Fact
    ros_type: Fact
    gz_type: Fact
    direction: Fact
    arrow: str = ""

    @property
    def kind(self) -> str:
        """The type in Gazebo, without its package."""
        return self.gz_type.value.rpartition(".")[2]

    @property
    def reaches_ros(self) -> bool:
        """True when it brings messages to ROS."""
        return self.direction.value != _TO_GZ

    @property
    def scoped(self) -> bool:
        """True for a name that Gazebo generates."""
        return bare(self.gz.value).startswith(_SCOPED)

    def turned(self, way: str) -> Fix:
        """Return the fix that gives it another direction."""
        said = self.direction
        if not self.arrow:
            return write(said.place, said.value, way, hint=f"write direction: {way}")
        sign = next(sign for sign, each in _ARROWS.items() if each == way)
        types = self.ros_type.value, self.gz_type.value
        wrong, right = self.arrow.join(types), sign.join(types)
        hint = f"write {sign} for {self.arrow} before {types[1]}"
        return write(said.place, wrong, right, hint=hint)

    def endpoints(self, topic: str) -> Iterator[Endpoint]:
        """Yield the publishers and subscriptions of the bridge for it.

        Args:
            topic: its full name in ROS.
        """
        gz = f"/{bare(self.gz.value)}"
        for publishes, way in ((True, _TO_GZ), (False, _TO_ROS)):
            if self.direction.value != way:
                kind, place, written = self.ros_type, self.ros.place, self.ros.value
                yield Endpoint(
                    topic, kind.value, publishes, place, written, typed_at=kind.place
                )
                kind, place, written = self.gz_type, self.gz.place, self.gz.value
                yield Endpoint(
                    gz, kind.value, not publishes, place, written, in_gazebo=True
                )


def bare(topic: str) -> str:
    """Return the full name of a topic without the first slash."""
    return topic.strip().strip("/")


def meant_key(key: str, entry: Mapping[str, Fact]) -> str | None:
    """Return the key that an unknown key of an entry misspells.

    Args:
        key: as the file has it.
        entry: all keys of the entry.
    """
    modern = key.replace("ign_", "gz_", 1) if key.startswith("ign_") else key
    if modern in _KEYS or modern in _OTHER_KEYS:
        return None
    return nearest(key, [each for each in _KEYS if each not in entry], _LIKENESS)


def entries_of_file(file: YamlFile) -> Iterator[BridgeEntry]:
    """Yield the entries in a file of a bridge, with misspelt keys as they are meant."""
    for written in file.entries():
        given = {meant_key(key, written) or key: v for key, v in written.items()}
        both = given.get("topic_name")
        ros = given.get("ros_topic_name", both)
        gz = given.get("gz_topic_name", given.get("ign_topic_name", both))
        ros, gz = ros or gz, gz or ros
        ros_type = given.get("ros_type_name")
        gz_type = given.get("gz_type_name", given.get("ign_type_name"))
        if ros is None or gz is None or ros_type is None or gz_type is None:
            continue
        yield BridgeEntry(
            ros, gz, ros_type, gz_type, given.get("direction", Fact(_BOTH, ros.place))
        )


def entries_in(
    arguments: Iterable[tuple[str | None, Place]],
    remappings: Iterable[tuple[str, str]],
) -> Iterator[BridgeEntry]:
    """Yield the entries in the arguments of a bridge.

    Args:
        arguments: its arguments with their places.
        remappings: topic → topic.
    """
    names = list(remappings)
    for argument, place in arguments:
        found = _BRIDGED.fullmatch(argument or "")
        if found is not None:
            topic, ros_type, arrow, gz_type = found.groups()
            renamed = (new for old, new in names if bare(old) == bare(topic))
            ends = next(renamed, topic), topic, ros_type, gz_type
            yield _argument(place, ends, arrow)


def _argument(place: Place, ends: tuple[str, str, str, str], arrow: str) -> BridgeEntry:
    """Return the entry of an argument, with its topics and types of ROS and Gazebo."""
    ros, gz, ros_type, gz_type, way = (
        Fact(text, place) for text in (*ends, _ARROWS[arrow])
    )
    return BridgeEntry(ros, gz, ros_type, gz_type, way, arrow)


def entries_of_images(
    arguments: Iterable[tuple[str | None, Place]],
    remappings: Iterable[tuple[str, str]],
) -> Iterator[BridgeEntry]:
    """Yield the entries in the arguments of a bridge for images.

    Args:
        arguments: its arguments with their places.
        remappings: topic → topic.
    """
    names = {bare(old): new for old, new in remappings}
    for argument, place in arguments:
        if argument is None or argument.startswith("-"):
            # What comes after options is not a topic.
            return
        if _NAME.fullmatch(argument):
            ros = names.get(bare(argument), argument)
            ends = ros, argument, "sensor_msgs/msg/Image", "gz.msgs.Image"
            yield _argument(place, ends, "[")
