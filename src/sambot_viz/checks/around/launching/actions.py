"""A launch file in one form, whether it is Python, XML or YAML.

Texts are kept as expressions: their values depend on launch arguments, and so on who
includes the file.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sambot_viz.errors import Place


@dataclass(frozen=True, slots=True)
class Joined:
    """Texts one after the other.

    Attributes:
        parts: the texts.
        is_path: they are joined as parts of a path.
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
    """A text that is worked out of others.

    Attributes:
        name: what is done; "eval" is an expression of Python.
        operands: what it is done with.
    """

    name: Literal["eval", "not", "and", "or", "equals", "differs", "if-else"]
    operands: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class RobotText:
    """The text of a robot, as xacro or a file gives it.

    Attributes:
        source: the command or the path that it comes from.
    """

    source: Expression


Expression = str | Joined | LaunchArgument | ShareFolder | Operation | RobotText | None
"""A text; None for one that is not known."""


@dataclass(frozen=True, slots=True)
class WrittenValue:
    """A parameter that is written in a launch file.

    Attributes:
        name: its name, with dots.
        values: its value, or the items of a list; None when they are not known.
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
"""What a node is given as parameters."""


@dataclass(frozen=True, slots=True)
class Action:
    """One thing that a launch file does.

    Attributes:
        place: its line.
        condition: the text that has to be true.
    """

    place: Place
    condition: Expression


@dataclass(frozen=True, slots=True)
class SetArgument(Action):
    """A value for a launch argument.

    Attributes:
        name: of the argument.
        value: the value; None when it has to be given.
        declares: a value that is there already is kept.
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
        name: what it is called; empty for the program's own name.
        namespace: empty for that around it.
        given: its parameters.
        remappings: topic, and what it becomes.
        arguments: its arguments.
        complete: its parameters and arguments are all known.
        argument_places: the place of each of the arguments, where these have their own.
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
    """Actions together.

    Attributes:
        actions: the actions.
        scoped: what is set inside ends with it.
    """

    actions: tuple[Action, ...]
    scoped: bool


@dataclass(frozen=True, slots=True)
class ForNodes(Action):
    """What all nodes get that follow in the same group.

    Attributes:
        namespace: is put before their names; empty for none.
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
