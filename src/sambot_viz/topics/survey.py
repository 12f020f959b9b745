"""A look at the first messages of all topics: enough to say what is wrong with them.

A recording of any length costs the same: so many messages are looked at, and of each
topic so many are decoded.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sambot_viz import limits
from sambot_viz.errors import FrameError
from sambot_viz.frames import FrameHistory, FrameTree, LookupRefused
from sambot_viz.frames.frame_prefix import frame_prefix
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.frames.transform import Transform
from sambot_viz.robot.xml.decode import XmlFault
from sambot_viz.robot.xml.element import Element, parse_xml
from sambot_viz.sources.message import Recorded
from sambot_viz.topics.looked import Looked
from sambot_viz.topics.robot_topics import top_frame
from sambot_viz.topics.source_robot import SourceRobot


class Survey:
    """Looks at the first messages of a recording, a few at a time.

    Args:
        recorded: the recording, and which topics of it are transforms.

    Attributes:
        recording: its messages.
        topics: what was seen, by name.
        transforms: what /tf and /tf_static told.
        is_all: every message was met.
        is_complete: nothing more is looked at.
    """

    def __init__(self, recorded: SourceRobot) -> None:
        self.recorded = recorded
        assert recorded.recording is not None, "messages are looked at by their times"
        self.recording = recorded.recording
        self.topics: dict[str, Looked] = {}
        self.is_all = False
        self.is_complete = False
        self._moving = frozenset(recorded.topics.moving)
        # The frames of robots with name spaces have the names of the page.
        self.transforms = recorded.transforms(FrameHistory())
        self._steps = self._run()
        self._tree: tuple[FrameTree, str] | None = None

    def step(self) -> bool:
        """Look at one more message; False when there is nothing more to look at."""
        return next(self._steps, None) is not None

    def finish(self) -> None:
        """Look at all that is to be looked at."""
        while self.step():
            pass

    def of(self, topic: str) -> Looked:
        """Return what was seen of a topic."""
        return self.topics.get(topic) or Looked()

    def lookup_fault(self, frame: str) -> LookupRefused | None:
        """Return why a frame has no place; None when it has one, or nothing has."""
        tree, fixed_frame = self._looked_up()
        if not fixed_frame:
            return None
        try:
            tree.lookup(fixed_frame, frame)
        except LookupRefused as refused:
            return refused
        return None

    @property
    def fixed_frame(self) -> str:
        """The frame at the top of the robot's tree; empty when there are no frames."""
        return self._looked_up()[1]

    # Looking

    def _run(self) -> Iterator[bool]:
        recording = self.recording
        latched = [m for m in recording.latched() if m.topic in self.transforms.always]
        for message in latched:
            self.transforms.take(message)
        size = number = 0
        for message in recording.messages():
            self._look(message)
            number, size = number + 1, size + len(message.payload)
            yield True
            if number >= limits.SURVEYED.value or size >= limits.SURVEYED_BYTES.value:
                break
        else:
            self.is_all = True
        if not self.is_all:
            yield from self._look_later()
        self.is_complete = True

    def _look_later(self) -> Iterator[bool]:
        """Look at the first messages of topics that begin later."""
        recording = self.recording
        start = recording.start_ns or 0
        waiting = [n for n, t in recording.topics.items() if t.count != 0]
        late = [name for name in waiting if name not in self.topics]
        for name in late[: limits.SURVEYED_LATE.value]:
            message = recording.next(name, start - 1)
            if message is not None:
                self._look(message)
            yield True

    def _look(self, message: Recorded) -> None:
        looked = self.topics.setdefault(message.topic, Looked())
        looked.seen += 1
        looked.last_ns = message.log_ns
        if looked.first_ns is None:
            looked.first_ns = message.log_ns
        if message.topic in self._moving:
            before = self.transforms.undecoded[message.topic]
            self.transforms.take(message)
            failed = self.transforms.undecoded[message.topic] - before
            looked.decoded += 1
            looked.undecoded += failed
        elif looked.decoded < limits.SURVEYED_DECODED.value:
            looked.decode(message, self.recorded.decode)

    # Frames

    def _looked_up(self) -> tuple[FrameTree, str]:
        if self._tree is None:
            self._tree = self._frames()
        return self._tree

    def _frames(self) -> tuple[FrameTree, str]:
        """Return all frames, and the one at the top of the robot's tree."""
        tree = FrameTree(self.transforms.history)
        root, joints = self._robot()
        pairs = list(self.transforms.pairs())
        self._hang(tree, joints, pairs)
        if root:
            root = frame_prefix(joints, pairs) + root
        first = root or next((parent for parent, _ in pairs), "")
        return tree, top_frame(first, (*joints, *pairs))

    def _robot(self) -> tuple[str, list[tuple[str, str]]]:
        """Return root and joints of the robot, by the names of frames."""
        root, joints = _robot_of(self.recorded.description)
        spaces, topic = self.recorded.spaces, self.recorded.topics.description or ""
        if not spaces:
            return root, joints
        named = [tuple(spaces.link_frame(topic, one) for one in j) for j in joints]
        return spaces.link_frame(topic, root), [(one, other) for one, other in named]

    def with_joints(self, tree: FrameTree) -> FrameTree:
        """Hang the links in a tree where messages do not say where they are."""
        _, joints = self._robot()
        self._hang(tree, joints, list(self.transforms.pairs()))
        return tree

    def _hang(
        self,
        tree: FrameTree,
        joints: Sequence[tuple[str, str]],
        pairs: Sequence[tuple[str, str]],
    ) -> None:
        if set(joints).isdisjoint(pairs) and not frame_prefix(joints, pairs):
            for parent, child in joints:
                try:
                    tree.set_static(parent, child, Transform.identity())
                except FrameError:
                    continue


_FLOATING = ("floating", "ball", "universal", "revolute2", "gearbox", "screw")
"""Types of joints that robot_state_publisher leaves out, in URDF and in SDF."""


def _robot_of(description: str | None) -> tuple[str, list[tuple[str, str]]]:
    """Return the root of a robot, and (parent, child) of the joints that hold links."""
    try:
        robot = parse_xml(description or "<robot/>", "")
    except XmlFault:
        return "", []
    # In SDF the names are texts, and there is a <model> around the links.
    robot = robot.find("model") or robot
    pairs: list[tuple[str, str]] = []
    for joint in (one for one in robot.iter() if one.tag == "joint"):
        parent, child = joint.find("parent"), joint.find("child")
        is_floating = joint.attributes.get("type") in _FLOATING
        if parent is None or child is None or is_floating:
            continue
        pairs.append((_link(parent, "link"), _link(child, "link")))
    children = {child for _, child in pairs}
    links = (_link(one, "name") for one in robot.children if one.tag == "link")
    return next((link for link in links if link not in children), ""), pairs


def _link(element: Element, attribute: str) -> str:
    return plain_name(element.attributes.get(attribute) or element.text.strip())
