"""The links and joints of a RobotModel: items of the document, and their rows.

RViz saves the entries under one of four keys, by their style, and reads them only from
"Links", in whatever style. All four keys are read here; a change is written where the
link or joint already has its entry.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal

from sambot_viz.displays.display import DisplayContext, EntryList, numbers
from sambot_viz.displays.robot_model.robot_properties import (
    ALL_ENABLED,
    ALL_LINKS_ENABLED,
    JOINT_PROPERTIES,
    LINK_PROPERTIES,
    STYLE,
    STYLES,
)
from sambot_viz.displays.scene.frame_nodes import position_of
from sambot_viz.geometry import Matrix, wxyz_from_matrix
from sambot_viz.robot.model import Robot
from sambot_viz.robot.parts import Joint, Link
from sambot_viz.rviz import DisplayConfig, EntryItem
from sambot_viz.rviz.yaml.yaml_nodes import Plain

Thing = Literal["link", "joint"]
Keys = tuple[str, ...]

KEYS = ("Links", "Joints", "Link Tree", "Link/Joint Tree")
"""The key of each style."""
_TREES = KEYS[2:]
_DECLARED = {"link": LINK_PROPERTIES, "joint": JOINT_PROPERTIES}
WITH_AXIS = frozenset({"continuous", "revolute", "prismatic", "planar"})
BOX = "Value"
"""The property that shows or hides a link."""


class RobotEntries:
    """The entries of one robot in one display.

    Args:
        config: the display.
        robot: whose links and joints they are.
    """

    def __init__(self, config: DisplayConfig, robot: Robot) -> None:
        self._config = config
        self._robot = robot
        self._style = config.get(STYLE)
        self._styles: dict[str, str] = dict(zip(KEYS, STYLES, strict=True))
        if self._style in STYLES:
            self._styles["Links"] = self._style
        self._places: dict[tuple[Thing, str], Keys] = {}
        for key in KEYS:
            thing: Thing = "joint" if self._styles[key] == STYLES[1] else "link"
            self._find_places(config.dynamic(key), (key,), thing)
        self._switches = tuple(
            EntryItem(config, (key,), (ALL_LINKS_ENABLED,)) for key in KEYS[1:]
        )
        self._items: dict[tuple[Thing, str], EntryItem] = {}
        self._above = {joint.child: joint.name for joint in robot.joints.values()}

    def holds_for(self, robot: Robot) -> bool:
        """Return whether these are the entries of a robot in the style chosen now."""
        return robot is self._robot and self._config.get(STYLE) == self._style

    def link(self, name: str) -> EntryItem:
        """Return the item of a link."""
        item = self._item("link", name)
        item.assume(BOX, self._default_box(name))
        return item

    def joint(self, name: str) -> EntryItem:
        """The item of a joint; without its own box it shows its child link's."""
        item = self._item("joint", name)
        child = self._robot.joints[name].child
        item.assume(BOX, self.link(child).get(BOX))
        return item

    def set_link(self, name: str, path: str, value: object) -> Any:
        """Set a property of a link, and return the value it has now."""
        return self.link(name).set(path, value)

    def set_joint(self, name: str, path: str, value: object) -> Any:
        """Set a property of a joint; links follow its box.

        Its child does; in a tree all links below it do.
        """
        item = self.joint(name)
        if path != BOX:
            return item.set(path, value)
        in_tree = self._is_tree(self._place("joint", name))
        for link in self._carried(name, all_below=in_tree):
            # In the list of joints, a link without a box follows the joint's.
            if in_tree or self.link(link).is_given(BOX):
                self.link(link).set(BOX, value)
        return item.set(path, value)

    def set_all(self, enabled: bool) -> None:
        """Tick or untick every link."""
        for switch in self._switches:
            if switch.is_given(ALL_LINKS_ENABLED.name):
                switch.set(ALL_LINKS_ENABLED.name, enabled)
        for thing, name in {**self._places, **self._items}:
            item = self._item(thing, name)
            if item.is_given(BOX):
                item.set(BOX, enabled)

    def _find_places(
        self, tree: Mapping[str, Plain], above: Keys, thing: Thing
    ) -> None:
        """Note where the file has an entry for which link or joint."""
        names = {"link": self._robot.links, "joint": self._robot.joints}
        other: Thing = "joint" if thing == "link" else "link"
        for name, entry in tree.items():
            # A file may have rows of another style than the one it names.
            found = other if name not in names[thing] and len(above) == 1 else thing
            if name not in names[found]:
                continue
            keys = (*above, name)
            self._places[found, name] = keys
            if self._is_tree(keys) and isinstance(entry, dict):
                both = self._styles[keys[0]] == STYLES[3]
                below: Thing = "link" if found == "joint" else "joint"
                self._find_places(entry, keys, below if both else found)

    def _is_tree(self, keys: Keys) -> bool:
        """Return whether the entries at a place are nested."""
        return self._styles[keys[0]] in STYLES[2:]

    def _item(self, thing: Thing, name: str) -> EntryItem:
        item = self._items.get((thing, name))
        if item is None:
            keys = self._place(thing, name)
            item = EntryItem(
                self._config, keys, _DECLARED[thing], nested=self._is_tree(keys)
            )
            self._items[thing, name] = item
        return item

    def _default_box(self, link: str) -> bool:
        """Return the box of a link that the file gives none."""
        joint = self._above.get(link)
        if joint is not None:
            # In the list of joints, a joint's box is its child link's.
            above = self._item("joint", joint)
            if above.is_given(BOX):
                return bool(above.get(BOX))
        enabled = self._config.get(ALL_ENABLED)
        for switch in self._switches:
            if switch.is_given(ALL_LINKS_ENABLED.name):
                enabled = switch.get(ALL_LINKS_ENABLED.name)
        return bool(enabled)

    def _place(self, thing: Thing, name: str) -> Keys:
        """Return where the entry is, or would be saved by RViz, in a tree or a list."""
        place = self._places.get((thing, name))
        if place is not None:
            return place
        for key in _TREES:
            joints = key == _TREES[1]
            if self._config.node_at((key,)) is not None and (thing == "link" or joints):
                return (key, *self._chain(thing, name, joints=joints))
        return ("Links" if thing == "link" else "Joints", name)

    def _chain(self, thing: Thing, name: str, *, joints: bool) -> Sequence[str]:
        """Return the entries from the root of a tree down to a link or joint."""
        chain: list[str] = []
        link = name
        if thing == "joint":
            chain.append(name)
            link = self._robot.joints[name].parent
        while True:
            chain.append(link)
            if link not in self._above:
                return chain[::-1]
            joint = self._above[link]
            if joints:
                chain.append(joint)
            link = self._robot.joints[joint].parent

    def _carried(self, joint: str, *, all_below: bool) -> Iterator[str]:
        """Yield the child link of a joint, or all links below it."""
        pending = [self._robot.joints[joint].child]
        while pending:
            link = pending.pop()
            yield link
            if all_below:
                joints = self._robot.joints.values()
                pending += [j.child for j in joints if j.parent == link]


FrameOf = Callable[[str], str]
_MOST_NAMES = 12


def robot_lists(
    context: DisplayContext, entries: RobotEntries, robot: Robot, frame_of: FrameOf
) -> tuple[EntryList, ...]:
    """Return the links and joints of a robot, in RViz's alphabetic order."""
    links = EntryList(
        "Links",
        "link",
        sorted(robot.links),
        entries.link,
        entries.set_link,
        lambda name: _link_facts(context, robot, name, frame_of),
        lambda name: _link_rows(robot.links[name]),
    )
    joints = EntryList(
        "Joints",
        "joint",
        sorted(robot.joints),
        entries.joint,
        entries.set_joint,
        lambda name: _joint_facts(context, robot.joints[name], frame_of),
        lambda name: _joint_rows(robot, robot.joints[name]),
    )
    return (links, joints) if robot.joints else (links,)


def collision_note(robot: Robot) -> str:
    """Name the links without a collision shape; "" when all have one."""
    bare = [name for name in sorted(robot.links) if not robot.links[name].collisions]
    if len(bare) == len(robot.links):
        return "No link of this robot has a collision shape."
    rest = len(bare) - _MOST_NAMES
    shown = ", ".join(bare[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")
    return f"Without a collision shape: {shown}" if bare else ""


def _link_rows(link: Link) -> Sequence[str]:
    """List the rows of a link: without geometry it has neither a box nor an Alpha."""
    rows = ("Show Trail", "Show Axes")
    return ("Value", "Alpha", *rows) if link.visuals or link.collisions else rows


def _joint_rows(robot: Robot, joint: Joint) -> Sequence[str]:
    rows = ["Show Axes"]
    child = robot.links[joint.child]
    if child.visuals or child.collisions:
        rows.insert(0, "Value")
    if joint.type in WITH_AXIS:
        rows.append("Show Joint Axis")
    return rows


def _pose_facts(T: Matrix | None) -> dict[str, str]:
    if T is None:
        return {"Position": "no transform"}
    w, x, y, z = wxyz_from_matrix(T)
    return {"Position": numbers(position_of(T)), "Orientation": numbers((x, y, z, w))}


def _pose(context: DisplayContext, frame: str) -> Matrix | None:
    fixed = context.fixed_frame
    if not context.nodes.connected(frame):
        return None
    return context.tree.drawn(fixed, frame).matrix


def _link_facts(
    context: DisplayContext, robot: Robot, name: str, frame_of: FrameOf
) -> Mapping[str, str]:
    facts = _pose_facts(_pose(context, frame_of(name)))
    joints = robot.joints.values()
    above = next((j.name for j in joints if j.child == name), None)
    facts["Parent joint"] = above or "none: it is the root link"
    below = sorted(j.name for j in joints if j.parent == name)
    facts["Child joints"] = ", ".join(below) or "none"
    link = robot.links[name]
    if not link.visuals and not link.collisions:
        facts["Geometry"] = "none"
    elif not link.visuals:
        facts["Geometry"] = "collision, but nothing visible"
    elif not link.collisions:
        facts["Geometry"] = "visible, but no collision"
    return facts


def _joint_facts(
    context: DisplayContext, joint: Joint, frame_of: FrameOf
) -> Mapping[str, str]:
    above = _pose(context, frame_of(joint.parent))
    facts = _pose_facts(None if above is None else above @ joint.origin.matrix)
    facts["Type"] = joint.type
    facts["Parent link"], facts["Child link"] = joint.parent, joint.child
    if joint.limit is not None:
        facts["Lower Limit"] = numbers((joint.limit.lower,))
        facts["Upper Limit"] = numbers((joint.limit.upper,))
    if joint.type in WITH_AXIS:
        facts["Joint Axis"] = numbers(joint.axis)
    return facts
