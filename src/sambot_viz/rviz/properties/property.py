"""Typed properties: declared once, then read, checked, shown and written.

A display, a view and a tool list their properties as objects of the classes in
`properties`; from that list come reading by RViz's rules, saving, the row in the panel
and the compatibility table.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Protocol, TypeAlias

from sambot_viz.errors import UsageError
from sambot_viz.rviz.yaml.yaml_nodes import List, Map, Node, Scalar

Support: TypeAlias = Literal["full", "approximate", "none", "kept"]
"""How far a property is shown; "kept" has no effect in RViz for ROS 2 either."""


class Report(Protocol):
    """Collects the warnings about a file."""

    def __call__(self, node: Node, message: str, hint: str, right: str = "") -> None:
        """Report a node.

        Args:
            node: the doubtful node.
            message: the warning.
            hint: the remedy.
            right: the text of a correct node, where it is certain.
        """


class PropertyError(UsageError):
    """A value that a property cannot have.

    Attributes:
        property: the property's name.
        value: what was given.
    """

    def __init__(self, name: str, value: object, expected: str):
        self.property, self.value = name, value
        shown = repr(value)
        shown = shown if len(shown) <= 60 else shown[:59] + "…"
        super().__init__(f"'{name}' must be {expected}, not {shown}")


def silent(node: Node, message: str, hint: str, right: str = "") -> None:
    """Drop a report."""
    del node, message, hint, right


@dataclass(frozen=True)
class Property:
    """A property of a display, view or tool; the subclasses say of which type.

    A subclass with no more fields has this one's methods: making such methods again
    for each class takes as long as reading a config.

    Attributes:
        name: the label, and the key in the file.
        default: the value while the file gives none.
        help: one sentence for the panel.
        unit: "m", "rad", "s", "Hz" or "".
        children: properties saved below this one.
        hidden_unless: (path, value): the row is shown only while the property at that
            path of the same display has that value (or one of a tuple of values). A
            hidden property is saved all the same.
        minimum: least value; smaller ones are raised to it.
        maximum: greatest value; greater ones are lowered to it.
        acts_up_to: greater values are kept, and act as this one.
        options: what can be chosen.
        read_only: shown, but never read from a file, set or saved.
        support: how far it is shown.
        note: a remark on that, for the compatibility table.
        ros1_default: the default in a file of ROS 1, when that is another one.
        ros1_only: only files of ROS 1 have it.
        aliases: other keys under which older files have it.
        open_keys: keys below it that are not declared belong to the robot (links,
            frames) and are not unknown keys.
    """

    name: str
    default: Any = None
    help: str = ""
    unit: str = ""
    children: tuple[Property, ...] = ()
    hidden_unless: tuple[str, object] | None = None
    minimum: Any = None
    maximum: Any = None
    acts_up_to: Any = None
    options: tuple[str, ...] = ()
    read_only: bool = False
    support: Support = "full"
    note: str = ""
    ros1_default: Any = None
    ros1_only: bool = False
    aliases: tuple[str, ...] = ()
    open_keys: bool = False

    @property
    def has_value(self) -> bool:
        """Return whether it has its own value; a mere container has none."""
        return True

    def default_in(self, ros1: bool) -> Any:
        """Return the default, in a file of ROS 1 or of ROS 2."""
        return (
            self.ros1_default
            if ros1 and self.ros1_default is not None
            else self.default
        )

    def read(self, node: Node | None, report: Report = silent) -> Any:
        """Read the property's own value by RViz's rules.

        Args:
            node: what the file has under its name: a scalar, or a map whose
                "Value" is the value; None when there is nothing.
            report: called with everything doubtful.

        Returns:
            The value, or None when the file gives no usable one and the default holds.
        """
        if isinstance(node, Map):
            node = node.get("Value")
        if node is None or isinstance(node, Map):
            return None
        if isinstance(node, List):
            report(
                node,
                f"'{self.name}' has a list where {self._expected} belongs; "
                f"{self._default_text()} is used",
                f"write {self._expected}",
            )
            return None
        return None if node.null else self._parse(node, report)

    def coerce(self, value: object) -> Any:
        """Check a value that a program or a browser gives.

        Args:
            value: anything.

        Returns:
            The value the property takes: of its own type, finite, within its limits.

        Raises:
            PropertyError: it is of another type, or not one of the options.
        """
        raise PropertyError(self.name, value, self._expected)

    def acting(self, value: Any) -> Any:
        """Return the value that one acts as (see `acts_up_to`)."""
        limit = self.acts_up_to
        return value if limit is None or value <= limit else limit

    def write(self, value: Any) -> str:
        """Return the text of a value, exactly as RViz saves it."""
        return str(value)

    def show(self, value: Any) -> str:
        """Return the text of a value for people, with few digits."""
        return self.write(value)

    def components(self, value: Any) -> dict[str, str] | None:
        """The keys a value is saved under, if it is saved as a map without "Value"."""
        del value
        return None

    def agrees(self, first: Any, second: Any) -> bool:
        """Return whether two values are the same for RViz."""
        return bool(first == second)

    def _parse(self, node: Scalar, report: Report) -> Any:
        del report
        return node.text

    @property
    def _expected(self) -> str:
        return "a value"

    def _default_stays(self, node: Scalar, report: Report, right: str = "") -> None:
        report(
            node,
            f"'{self.name}' is {node.text!r}, which is not {self._expected}; "
            f"{self._default_text()} is used",
            f"write {right or self._expected}",
            right,
        )

    def _default_text(self) -> str:
        text = "" if self.default is None else self.write(self.default)
        return f"the default {text}" if text else "the default"


@dataclass(frozen=True, repr=False, eq=False)
class KeptProperty(Property):
    """A key that RViz writes, or wrote, and that has no effect here.

    It is never set, and a new item does not get it; `note` says what RViz does with it.
    """

    read_only: bool = True
    open_keys: bool = True
    support: Support = "kept"

    @property
    def has_value(self) -> bool:
        """Return whether its value is used: it is not."""
        return False


class GroupProperty(Property):
    """A container: it has children and no value."""

    @property
    def has_value(self) -> bool:
        """Return whether it has a value: a container has none."""
        return False

    def write(self, value: Any) -> str:
        """Return the empty text: a container has no value."""
        del value
        return ""
