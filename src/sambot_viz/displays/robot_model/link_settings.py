"""What a file says about single links and joints of a RobotModel.

RViz saves the rows under one of four keys, by their style, and reads them only from
"Links", in whatever style. All four keys are read here; a change is written where the
link or joint already has its row.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from sambot_viz.displays.entries import is_on
from sambot_viz.robot.model import Robot
from sambot_viz.rviz import (
    BoolProperty,
    DisplayConfig,
    EnumProperty,
    FloatProperty,
    GroupProperty,
    Property,
)
from sambot_viz.rviz.yaml.nodes import Plain

Thing = Literal["link", "joint"]
Keys = tuple[str, ...]

STYLES = (
    "Links in Alphabetic Order",
    "Joints in Alphabetic Order",
    "Tree of links",
    "Tree of links and joints",
)
KEYS = ("Links", "Joints", "Link Tree", "Link/Joint Tree")
"""The key of each style."""
ALL_ENABLED = "Links/All Links Enabled"
_TREES = KEYS[2:]
_DETAILS = "Details"

LINK_TREE_PROPERTIES: tuple[Property, ...] = (
    GroupProperty(
        "Links",
        help="The links of the robot, each with settings of its own.",
        open_keys=True,
        children=(
            EnumProperty(
                "Link Tree Style",
                default=STYLES[0],
                options=STYLES,
                help="How RViz lists the links; here there is a list to choose from.",
                support="approximate",
            ),
            BoolProperty(
                "Expand Tree",
                default=False,
                help="Kept for RViz: its tree of links is not drawn here.",
                support="approximate",
            ),
            BoolProperty(
                "Expand Link Details",
                default=False,
                help="Kept for RViz: its tree of links is not drawn here.",
                support="approximate",
            ),
            BoolProperty(
                "Expand Joint Details",
                default=False,
                help="Kept for RViz: its tree of links is not drawn here.",
                support="approximate",
            ),
            BoolProperty(
                "All Links Enabled", default=True, help="Show or hide all links."
            ),
        ),
    ),
    GroupProperty("Joints", help="The joints.", open_keys=True, read_only=True),
    GroupProperty(
        "Link Tree", help="The links as a tree.", open_keys=True, read_only=True
    ),
    GroupProperty(
        "Link/Joint Tree",
        help="The links and joints as a tree.",
        open_keys=True,
        read_only=True,
    ),
)
LINK_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Value", default=True, help="Show the link."),
    FloatProperty(
        "Alpha",
        default=1.0,
        minimum=0.0,
        maximum=1.0,
        help="How opaque the link is, on top of the robot's own Alpha.",
    ),
    BoolProperty("Show Trail", default=False, help="Draw the way the link took."),
    BoolProperty("Show Axes", default=False, help="Draw the axes of the link."),
)
JOINT_PROPERTIES: tuple[Property, ...] = (
    BoolProperty("Value", default=True, help="Show the links that the joint carries."),
    BoolProperty("Show Axes", default=False, help="Draw the axes of the joint."),
    BoolProperty(
        "Show Joint Axis", default=False, help="Draw the axis the joint moves about."
    ),
)


@dataclass(frozen=True, slots=True)
class LinkSettings:
    """How one link is drawn."""

    enabled: bool = True
    alpha: float = 1.0
    show_axes: bool = False
    show_trail: bool = False


@dataclass(frozen=True, slots=True)
class JointSettings:
    """What is drawn for one joint; `enabled` is its box, if the file has one."""

    enabled: bool | None = None
    show_axes: bool = False
    show_joint_axis: bool = False


class RobotSettings:
    """The links and joints of one robot as a display's file has them.

    Args:
        config: the display.
        robot: whose links they are.
    """

    def __init__(self, config: DisplayConfig, robot: Robot) -> None:
        self._config = config
        self._robot = robot
        self._places: dict[tuple[Thing, str], Keys] = {}
        self._fields: dict[tuple[Thing, str], Mapping[str, Plain]] = {}
        self._all = bool(config.get(ALL_ENABLED))
        self._styles: dict[str, str] = dict(zip(KEYS, STYLES, strict=True))
        chosen = str(config.get("Links/Link Tree Style"))
        if chosen in STYLES:
            self._styles["Links"] = chosen
        for key in KEYS:
            tree = config.dynamic(key)
            if key != "Links" and "All Links Enabled" in tree:
                self._all = is_on(tree["All Links Enabled"])
            thing: Thing = "joint" if self._styles[key] == STYLES[1] else "link"
            self._walk(tree, (key,), thing)
        self._above = {joint.child: joint.name for joint in robot.joints.values()}

    def _walk(self, tree: Mapping[str, Plain], above: Keys, thing: Thing) -> None:
        names = {"link": self._robot.links, "joint": self._robot.joints}
        expected = thing
        style = self._styles[above[0]]
        for name, entry in tree.items():
            thing = expected
            if name not in names[thing] and len(above) == 1:
                # A file may have rows of another style than the one it names.
                thing = "joint" if thing == "link" else "link"
            if name not in names[thing]:
                continue
            below: Thing = thing
            if style == STYLES[3]:
                below = "joint" if thing == "link" else "link"
            fields: dict[str, Plain] = (
                dict(entry) if isinstance(entry, dict) else {"Value": entry}
            )
            details = fields.get(_DETAILS)
            if isinstance(details, dict):
                fields.update(details)
            keys = (*above, name)
            self._places[thing, name] = keys
            self._fields[thing, name] = fields
            if self._is_tree(keys) and isinstance(entry, dict):
                self._walk(entry, keys, below)

    def _is_tree(self, keys: Keys) -> bool:
        """Whether the rows at some place are nested, with their fields in Details."""
        return self._styles[keys[0]] in STYLES[2:]

    def link(self, name: str) -> LinkSettings:
        """The settings of a link; RViz's defaults where the file has none."""
        fields = self._fields.get(("link", name), {})
        enabled = self._all
        if "Value" in fields:
            enabled = is_on(fields["Value"])
        elif name in self._above:
            # In the list of joints, a joint's box is its child link's.
            box = self.joint(self._above[name]).enabled
            enabled = self._all if box is None else box
        return LinkSettings(
            enabled,
            _alpha(fields.get("Alpha")),
            is_on(fields.get("Show Axes"), False),
            is_on(fields.get("Show Trail"), False),
        )

    def joint(self, name: str) -> JointSettings:
        """The settings of a joint; RViz's defaults where the file has none."""
        fields = self._fields.get(("joint", name), {})
        return JointSettings(
            is_on(fields["Value"]) if "Value" in fields else None,
            is_on(fields.get("Show Axes"), False),
            is_on(fields.get("Show Joint Axis"), False),
        )

    def set(self, thing: Thing, name: str, key: str, value: Any) -> None:
        """Write one setting where the link or joint stands, or will stand."""
        keys = self._places.get((thing, name)) or self._new_place(thing, name)
        if key != "Value" and self._is_tree(keys):
            keys = (*keys, _DETAILS)
        self._config.set_dynamic((*keys, key), value)
        if thing == "joint" and key == "Value":
            for link in self._carried(name, keys):
                # In the list of joints, a link without a box follows the joint's.
                if self._is_tree(keys) or "Value" in self._fields.get(
                    ("link", link), {}
                ):
                    self.set("link", link, "Value", value)

    def set_all(self, enabled: bool) -> None:
        """Tick or untick every link."""
        for key in _TREES:
            if "All Links Enabled" in self._config.dynamic(key):
                self._config.set_dynamic((key, "All Links Enabled"), enabled)
        for (thing, name), fields in list(self._fields.items()):
            if "Value" in fields:
                keys = self._places[thing, name]
                self._config.set_dynamic((*keys, "Value"), enabled)

    def _new_place(self, thing: Thing, name: str) -> Keys:
        """Where RViz would save it: below those above it in a tree, else in a list."""
        for key in _TREES:
            if self._config.dynamic(key) and (thing == "link" or key == _TREES[1]):
                return (key, *self._chain(thing, name, joints=key == _TREES[1]))
        return ("Links" if thing == "link" else "Joints", name)

    def _chain(self, thing: Thing, name: str, *, joints: bool) -> Sequence[str]:
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

    def _carried(self, joint: str, keys: Keys) -> Iterator[str]:
        """The links that follow a joint's box: its child; in a tree all below it."""
        pending = [self._robot.joints[joint].child]
        while pending:
            link = pending.pop()
            yield link
            if self._is_tree(keys):
                below = self._robot.joints.values()
                pending += [j.child for j in below if j.parent == link]


def _alpha(value: Plain) -> float:
    """An opacity; RViz takes any number, which drawing then limits to 0 … 1."""
    try:
        number = float(value) if isinstance(value, str) else 1.0
    except ValueError:
        return 0.0
    return min(1.0, max(0.0, number)) if number == number else 0.0
