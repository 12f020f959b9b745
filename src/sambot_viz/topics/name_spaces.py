"""Robots with name spaces: keep their frames apart in one tree.

Robots of one kind use the same names of frames, and each publishes them on topics of
its name space: /a/tf and /b/tf. tf2 listens to one of them. Here the frames of a name
space get its name, such as a/base_link, except the frames above the robots: a map is
the same for all.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

from sambot_viz import limits
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.samples import FramePair
from sambot_viz.topics.frame_limit import Transforms

_OF_THE_WORLD = frozenset({"map", "world", "earth"})
"""Frames that hold robots, and are part of none (REP 105)."""
_OF_A_ROBOT = frozenset({"base_link", "base_footprint"})
"""Frames that are part of a robot, also where nothing says what holds it (REP 105)."""
_MOST_KEPT = 1000
_MOST_NAMES = 4 * limits.FRAMES.value
_OF_TF = ("tf", "tf_static")
"""Topics that have name spaces; Foxglove's transforms are those of all robots."""
_PARTS = ("markers", "controls")
"""Arrays of messages whose elements have headers, or such arrays."""


def space_of(topic: str) -> str:
    """Return the name space of a topic, such as "/a" of "/a/tf"; "" without one."""
    return topic.rpartition("/")[0]


@dataclass(slots=True)
class _NamedFrame:
    """What name spaces say of a frame that they call alike.

    Attributes:
        spaces: those that name it; "" for topics without a name space.
        is_own: it is part of a robot: one with a name space holds it at another frame,
            or it carries the name of one.
        given: name space → the name of its frame.
    """

    spaces: set[str] = field(default_factory=set[str])
    is_own: bool = False
    given: dict[str, str] = field(default_factory=dict[str, str])

    def is_shared(self, frame: str) -> bool:
        """Return whether the frame is one and the same for all robots."""
        if self.is_own:
            return False
        if "" in self.spaces or frame in _OF_THE_WORLD:
            return True
        return len(self.spaces) > 1 and frame not in _OF_A_ROBOT


class NameSpaces:
    """Names the frames of robots that tell of them on topics of several name spaces.

    Where they come in one, each frame keeps its name. Threads may share it.

    Attributes:
        version: grows when frames that were named get other names: what was known of
            frames is then to be forgotten.
    """

    def __init__(self) -> None:
        self.version = 0
        self._spaces = frozenset[str]()
        self._known: dict[str, _NamedFrame] = {}
        # Name → whose it is; None for what several share.
        self._names: dict[str, tuple[str, str] | None] = {}
        self._lock = threading.Lock()
        # By id: a decoder gives the same tuple for the messages of one publisher.
        self._kept: dict[
            tuple[str, int], tuple[tuple[FramePair, ...], tuple[FramePair, ...]]
        ] = {}
        self._edges: dict[tuple[FramePair, ...], tuple[FramePair, ...]] = {}

    def __bool__(self) -> bool:
        return bool(self._spaces)

    def set_spaces(self, spaces: Iterable[str]) -> None:
        """Keep the frames of these name spaces apart; of none, where there is one."""
        separate = frozenset(spaces)
        with self._lock:
            if separate != self._spaces:
                self._spaces = separate
                self._known.clear()
                self._names.clear()
                self._begin_again()

    def prefix_of(self, topic: str) -> str:
        """Return the prefix of the frames of a topic, such as "a/", or "".

        Of nested name spaces the innermost one counts.
        """
        space = space_of(topic) if self._spaces else ""
        while space and space not in self._spaces:
            space = space_of(space)
        return f"{space}/".removeprefix("/")

    def transforms(self, topic: str, transforms: Transforms) -> Transforms:
        """Return the transforms of a message with the names of its frames."""
        if not self._spaces:
            return transforms
        prefix = self.prefix_of(topic)
        return [
            (stamp, self._named(prefix, edges), poses)
            for stamp, edges, poses in transforms
        ]

    def frame_of(self, topic: str, frame: str) -> str:
        """Return the frame in the tree for a name in a message of a topic.

        A frame of the topic's name space comes first, then one of others with that
        name.
        """
        prefix = self.prefix_of(topic)
        frame = plain_name(frame)
        if not prefix or not frame:
            return frame
        known = self._known.get(frame)
        if known is not None and prefix in known.given:
            return known.given[prefix]
        if frame in self._names or (known is not None and known.is_shared(frame)):
            return frame
        return _put(prefix, frame)

    def link_frame(self, topic: str, link: str) -> str:
        """Return the frame of a link of the robot that a topic describes."""
        prefix = self.prefix_of(topic)
        known, put = self._known.get(link), _put(prefix, link)
        written = self._known.get(put)
        is_told = known is not None and prefix in known.spaces
        if written is not None and prefix in written.spaces and not is_told:
            # The prefix is part of the names that its own transforms have.
            return written.given.get(prefix, put)
        if not prefix or (known is not None and known.is_shared(link)):
            return link
        return put if known is None else known.given.get(prefix, put)

    def meant(self, frame: str, preferred: Iterable[str] = ()) -> tuple[str, ...]:
        """Return the frames for a name without a name space.

        Args:
            frame: the name in a config.
            preferred: topics of the robots that come before others.

        Returns:
            The name itself if it is a frame, or if no name space has such a frame.
        """
        frame = plain_name(frame)
        with self._lock:
            if frame in self._names:
                return (frame,)
            known = self._known.get(frame)
            given = {} if known is None else dict(known.given)
            if known is None:
                given = self._of_its_space(frame)
        if not given:
            return (frame,)
        named = {self.prefix_of(topic) for topic in preferred}
        found = [name for prefix, name in given.items() if prefix in named]
        return tuple(found) if len(found) == 1 else tuple(sorted(given.values()))

    def _of_its_space(self, frame: str) -> dict[str, str]:
        """Return the frame for a name that begins with a name space, by its prefix."""
        prefix = self.prefix_of(f"/{frame}")
        known = self._known.get(frame.removeprefix(prefix)) if prefix else None
        return {p: n for p, n in known.given.items() if p == prefix} if known else {}

    def name_frames(self, topic: str, message: Any) -> None:
        """Give the headers of a message the names of the frames that they mean."""
        if not self._spaces:
            return
        header = getattr(message, "header", None)
        if header is not None and hasattr(header, "frame_id"):
            header.frame_id = self.frame_of(topic, str(header.frame_id))
        for part in _PARTS:
            elements = getattr(message, part, None)
            if isinstance(elements, (list, tuple)):
                for element in cast("Sequence[Any]", elements):
                    self.name_frames(topic, element)

    def _named(
        self, prefix: str, edges: tuple[FramePair, ...]
    ) -> tuple[FramePair, ...]:
        kept = self._kept.get((prefix, id(edges)))
        if kept is not None:
            return kept[1]
        with self._lock:
            if self._notes(prefix, edges):
                self._begin_again()
            if len(self._kept) >= _MOST_KEPT:
                self._kept.clear()
                self._edges.clear()
            named = tuple(
                (self._name(prefix, parent), self._name(prefix, child))
                for parent, child in edges
            )
            named = self._edges.setdefault(named, named)
            self._kept[prefix, id(edges)] = edges, named
            return named

    def _notes(self, prefix: str, edges: Sequence[FramePair]) -> bool:
        """Note who names which frames; return whether some get other names by that."""
        is_other = False
        for edge in edges:
            for is_child, raw in enumerate(edge):
                frame = plain_name(raw)
                known = self._known.get(frame)
                if known is None:
                    if len(self._known) >= _MOST_NAMES:
                        continue
                    carries = self.prefix_of(f"/{frame}") != ""
                    known = self._known[frame] = _NamedFrame(is_own=carries)
                before = known.is_shared(frame)
                known.spaces.add(prefix)
                known.is_own = known.is_own or bool(is_child and prefix)
                if known.given and before != known.is_shared(frame):
                    for name in known.given.values():
                        self._names.pop(name, None)
                    known.given.clear()
                    is_other = True
        return is_other

    def _name(self, prefix: str, raw: str) -> str:
        frame = plain_name(raw)
        known = self._known.get(frame)
        if known is None:
            return _put(prefix, frame)
        name = known.given.get(prefix)
        if name is None:
            is_own = bool(prefix) and not known.is_shared(frame)
            owner = (prefix, frame) if is_own else None
            name = _put(prefix, frame) if is_own else frame
            # A robot may call a frame as another one's is called here.
            while is_own and self._names.get(name) is not None:
                name = prefix + name
            known.given[prefix] = name
            self._names[name] = owner
        return name

    def _begin_again(self) -> None:
        self._kept.clear()
        self._edges.clear()
        self.version += 1


def _put(prefix: str, frame: str) -> str:
    """Put the name of a name space before a frame, unless it is there already."""
    return frame if frame.startswith(prefix) else prefix + frame


def separate_spaces(transforms: Iterable[str], described: Iterable[str]) -> list[str]:
    """Return the name spaces whose frames are to be kept apart.

    Transforms without a name space are those of all robots that have none in their
    own. Without such, each robot has its name space.

    Args:
        transforms: topics of transforms.
        described: topics of descriptions.

    Returns:
        None where there is one robot, or all robots share the same transforms.
    """
    spaces = {
        space_of(topic) if topic.rpartition("/")[2] in _OF_TF else ""
        for topic in transforms
    }
    robots, told = {space_of(topic) for topic in described}, spaces - {""}
    if "" in spaces:
        is_apart = len(told) > 1 or bool(told and told < robots)
        return sorted(told) if is_apart else []
    is_apart = len(told) > 1 or (len(robots) > 1 and told <= robots)
    return sorted((told | robots) - {""}) if is_apart else []
