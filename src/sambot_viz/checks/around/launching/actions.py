"""Represent launch files in Python, XML and YAML in one form.

Texts stay expressions: their values depend on launch arguments, which the including
file may set.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sambot_viz.errors import Place


@dataclass(frozen=True, slots=True)
class Joined:
    """Texts joined in their order.

    Attributes:
        parts: the texts.
        is_path: launch joins them as parts of a path.
    """

    parts: tuple[Expression, ...]
    is_path: bool = False


@dataclass(frozen=True, slots=True)
class LaunchArgument:
    """The value of a launch argument.

    Attributes:
        name: of the argument.
        default: its value where the argument does not exist.
    """

    name: Expression
    default: Expression = None


@dataclass(frozen=True, slots=True)
class ShareFolder:
    """The share folder of a package; of the launch file's own folder without a name.

    Attributes:
        package: its name; empty for the folder of the launch file.
    """

    package: Expression


@dataclass(frozen=True, slots=True)
class Operation:
    """A text that launch computes from others.

    Attributes:
        name: the operation; "eval" evaluates an expression of Python.
        operands: the inputs of the operation.
    """

    name: Literal["eval", "not", "and", "or", "equals", "differs", "if-else"]
    operands: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class RobotText:
    """The text of a robot, as xacro or a file gives it.

    Attributes:
        source: the command or the path that returns it.
    """

    source: Expression


Expression = str | Joined | LaunchArgument | ShareFolder | Operation | RobotText | None
"""A text; None for an unknown one."""


@dataclass(frozen=True, slots=True)
class WrittenValue:
    """A parameter in a launch file.

    Attributes:
        name: its name, with dots.
        values: its value, or the items of a list; None when unknown.
        place: its line.
    """

    name: Expression
    values: tuple[Expression, ...] | None
    place: Place


@dataclass(frozen=True, slots=True)
class FromFile:
    """The parameters in a file.

    Attributes:
        path: the file.
        place: where the launch file names it.
        rewritten: launch changes some of them before the node reads them.
    """

    path: Expression
    place: Place
    rewritten: bool = False


Given = WrittenValue | FromFile
"""The parameters of a node."""


@dataclass(frozen=True, slots=True)
class Action:
    """An action of a launch file.

    Attributes:
        place: its line.
        condition: the text that must be true.
    """

    place: Place
    condition: Expression


@dataclass(frozen=True, slots=True)
class SetArgument(Action):
    """A value for a launch argument.

    Attributes:
        name: of the argument.
        value: the value; None when the user must set it.
        declares: an existing value remains.
    """

    name: Expression
    value: Expression
    declares: bool


@dataclass(frozen=True, slots=True)
class StartNode(Action):
    """A node.

    Attributes:
        package: its package.
        executable: the program; of a component its class.
        name: its name; empty for the program's own name.
        namespace: its namespace; empty for the surrounding one.
        given: its parameters.
        remappings: topic, and what it becomes.
        arguments: its arguments.
        complete: all its parameters and arguments are known.
        argument_places: the place of each argument, where they have separate places.
    """

    package: Expression
    executable: Expression
    name: Expression
    namespace: Expression
    given: tuple[Given, ...] = ()
    remappings: tuple[tuple[Expression, Expression], ...] = ()
    arguments: tuple[Expression, ...] = ()
    complete: bool = True
    argument_places: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class StartProcess(Action):
    """A program that is not a node.

    Attributes:
        words: the command.
    """

    words: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class IncludeFile(Action):
    """Another launch file.

    Attributes:
        path: the file.
        arguments: its launch arguments with their values.
    """

    path: Expression
    arguments: tuple[tuple[Expression, Expression], ...]


@dataclass(frozen=True, slots=True)
class ActionGroup(Action):
    """A group of actions.

    Attributes:
        actions: the actions.
        scoped: settings inside end with the group.
    """

    actions: tuple[Action, ...]
    scoped: bool


@dataclass(frozen=True, slots=True)
class ForNodes(Action):
    """Settings for all later nodes of the same group.

    Attributes:
        namespace: precedes their names; empty for none.
        given: parameters.
        remappings: topic, and what it becomes.
    """

    namespace: Expression = ""
    given: tuple[Given, ...] = ()
    remappings: tuple[tuple[Expression, Expression], ...] = ()


@dataclass(frozen=True, slots=True)
class UnknownAction(Action):
    """An action that may start more.

    Attributes:
        what: its name.
    """

    what: str
