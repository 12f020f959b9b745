"""Types that are known without a definition: ROS's own, and .msg files of the user's.

A recording of Humble and older has no definitions in its database, and a bridge may
have none. Distributions differ in a few types, so several definitions may be given.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz import limits
from sambot_viz.errors import DecodeError
from sambot_viz.messages.definition import Lookup, TypeDefinition, Types, closed
from sambot_viz.messages.definition_text import parsed_types

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

_DISTROS = (
    # Without definitions are recordings of Humble and older; the others follow for
    # types that came later.
    *("ros2_humble", "ros2_lyrical", "ros2_kilted", "ros2_jazzy", "ros2_iron"),
    *("ros2_galactic", "ros2_foxy", "ros2_eloquent", "ros2_dashing"),
)
_ROS1 = ("ros1_noetic",)
_TRANSFORMS = "tf2_msgs/msg/TFMessage"
_ROS1_TRANSFORMS = (_TRANSFORMS, "tf/msg/tfMessage")
"""Types of ROS 1 that rosbags does not have: a list of transforms, as in ROS 2."""
_PLACES = (
    "{package}/msg/{name}.msg",
    "share/{package}/msg/{name}.msg",
    "{package}/share/{package}/msg/{name}.msg",
    "src/{package}/msg/{name}.msg",
)
"""Where a message is below a folder of packages, an installation, or a workspace."""
_DRAWN = {
    "map_msgs/msg/OccupancyGridUpdate": "std_msgs/Header header\nint32 x\nint32 y\n"
    "uint32 width\nuint32 height\nint8[] data\n",
    "nav2_msgs/msg/Particle": "geometry_msgs/Pose pose\nfloat64 weight\n",
    "nav2_msgs/msg/ParticleCloud": "std_msgs/Header header\nParticle[] particles\n",
}
"""Types that displays draw and rosbags does not have."""
_TYPE = re.compile(r"([A-Za-z]\w*)/msg/([A-Za-z]\w*)", re.ASCII)


class KnownTypes:
    """Finds definitions by the name of a type.

    Args:
        msg_path: folders with .msg files.
        distro: the ROS distribution whose types come first, such as "humble".
    """

    def __init__(self, msg_path: Sequence[Path], distro: str | None) -> None:
        self._folders = tuple(msg_path)
        first = f"ros2_{distro}"
        self._distros = tuple(sorted(_DISTROS, key=lambda one: one != first))

    def find(self, name: str, encoding: str) -> Types | None:
        """Return a type that a definition names and does not have."""
        for lookup in (*self._standard(encoding), self._from_files):
            if (found := lookup(name)) is not None:
                return found
        return None

    def definitions(self, name: str, encoding: str) -> list[TypeDefinition]:
        """Return all different definitions of a type, the most likely first."""
        found: list[TypeDefinition] = []
        for find in self._lookups(encoding):
            try:
                one = closed(name, {}, find)
            except DecodeError:
                continue
            if one not in found:
                found.append(one)
        return found

    def _lookups(self, encoding: str) -> Iterator[Lookup]:
        standard = self._standard(encoding)
        for lookup in standard:
            yield lambda name, one=lookup: one(name) or self._from_files(name)
        yield lambda name: self._from_files(name) or self.find(name, encoding)

    def _standard(self, encoding: str) -> list[Lookup]:
        distros = _ROS1 if encoding == "ros1" else self._distros
        return [
            lambda name, one=distro: _standard_type(one, name) for distro in distros
        ]

    def _from_files(self, name: str) -> Types | None:
        # The name comes from a recording: no part of it may be a way out of a folder.
        if (match := _TYPE.fullmatch(name)) is None:
            return None
        for path in self._paths(*match.groups()):
            if (text := _text(path)) is not None:
                try:
                    return parsed_types(name, "ros2msg", text)
                except DecodeError:
                    continue
        text = _DRAWN.get(name)
        return None if text is None else parsed_types(name, "ros2msg", text)

    def _paths(self, package: str, name: str) -> Iterator[Path]:
        for folder in self._folders:
            if folder.absolute().name == package:
                yield folder / "msg" / f"{name}.msg"
            for place in _PLACES:
                yield folder / place.format(package=package, name=name)


def _standard_type(distro: str, name: str) -> Types | None:
    fields = standard_types(distro).get(name)
    return None if fields is None else {name: fields}


@cache
def standard_types(distro: str) -> Types:
    """Return the types that a distribution of ROS has by itself."""
    fielddefs = _store(distro).fielddefs
    types = {name: fields for name, (_, fields) in fielddefs.items()}
    if distro in _ROS1:
        transforms = standard_types("ros2_humble")[_TRANSFORMS]
        types |= dict.fromkeys(_ROS1_TRANSFORMS, transforms)
    return types


@lru_cache(maxsize=4096)
def standard_definition(name: str, type_hash: str = "") -> str:
    """Return the text of a type that ROS has by itself, as a recording has it.

    Args:
        name: of the type.
        type_hash: which of its definitions, such as RIHS01_…; "" for the first one.

    Returns:
        The text; "" where no distribution has that definition.
    """
    for distro in _DISTROS:
        store = _store(distro)
        if name in store.fielddefs and type_hash in ("", store.hash_rihs01(name)):
            return store.generate_msgdef(name, ros_version=2)[0]
    return ""


def standard_hash(name: str) -> str:
    """Return the hash of a type as ROS has it by itself; "" where it has none.

    Of its definitions it is that with which messages are written.
    """
    for distro in _DISTROS:
        store = _store(distro)
        if name in store.fielddefs:
            return store.hash_rihs01(name)
    return ""


@cache
def _store(distro: str) -> Typestore:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores(distro))


def _text(path: Path) -> str | None:
    try:
        if path.stat().st_size > limits.DEFINITION.value:
            return None
        return path.read_text("utf-8", "replace")
    except (OSError, ValueError):
        return None
