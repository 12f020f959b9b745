"""The command line as `Options`: flags and NAME:=VALUE words, one clear error line."""

from __future__ import annotations

import argparse
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import Field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

from sambot_viz.commands.ros_arguments import without_ros_arguments
from sambot_viz.errors import UsageError, nearest
from sambot_viz.files import is_recording
from sambot_viz.flags import Flag, Group, declared, flag_of
from sambot_viz.options import Options
from sambot_viz.outlet import write_err, write_lines
from sambot_viz.text import line

# Commands such as check must not wait for modules that only others need.
if TYPE_CHECKING:
    from sambot_viz.frames import FrameTree
    from sambot_viz.inputs import Inputs
    from sambot_viz.joints import JointState
    from sambot_viz.robot.model import Robot

T = TypeVar("T")
_ARGUMENT = re.compile(r"\s*([A-Za-z_][\w.-]*)\s*:=(.*)", re.DOTALL)
_YES, _NO = ("true", "1"), ("false", "0")
_ABOUT_MODELS = (
    "Without MODEL, the bundled sam_bot is used. NAME:=VALUE is an argument for xacro, "
    "anywhere on the line."
)


LISTEN, LONGEST_LISTEN = 2.0, 3600.0
"""How long commands that look once listen to a live robot: usual and maximum [s]."""


class Parser(argparse.ArgumentParser):
    """A command's parser; a bad command line is one line, not the whole usage.

    Args:
        prog: the command, such as "sambot-viz check".
        groups: the groups of `Options` that it takes; with any, it takes a MODEL.
        takes_model: whether it does.
        takes_arguments: whether it takes NAME:=VALUE, as it does with a MODEL.
        model: what MODEL is.
        rest: as for `argparse.ArgumentParser`.

    Attributes:
        takes_model: whether the command takes a MODEL.
        takes_arguments: whether it takes NAME:=VALUE.
        alone: flags whose value, if any, is written in the same word, and the value
            without one.
    """

    def __init__(
        self,
        prog: str,
        groups: Sequence[Group] = (),
        model: str = "model file or package folder",
        takes_model: bool = True,
        takes_arguments: bool = False,
        **rest: Any,
    ) -> None:
        self.takes_model = takes_model and bool(groups)
        self.takes_arguments = takes_arguments or self.takes_model
        if self.takes_model:
            rest.setdefault("epilog", _ABOUT_MODELS)
        super().__init__(prog=prog, **rest)
        self.options = [o for o in declared(Options) if _is_taken(flag_of(o), groups)]
        if self.takes_model:
            add = self.add_argument
            add("model", nargs="?", metavar="MODEL", help=model)
            add(
                "--model", dest="model_option", metavar="PATH", help="the same, by name"
            )
        for option in self.options:
            _add(self, option)
        self.alone = {
            name: os.environ.get(flag_of(option).variable, "")
            for option in self.options
            if flag_of(option).optional_value == "="
            for name in flag_of(option).names
        }
        self.add_argument(
            "--debug", action="store_true", help="show where an internal error occurred"
        )

    @property
    def actions(self) -> Sequence[argparse.Action]:
        """What the parser takes, in order; argparse has no public name for it."""
        return self._actions

    def add_format(self, *others: str) -> None:
        """Add ``--format``, for commands that print text, JSON or other formats."""
        self.add_argument(
            "--format",
            choices=("text", "json", *others),
            default="text",
            help="how to print it (default: %(default)s)",
        )

    def add_open(self) -> None:
        """Add ``--open``, for commands with a page."""
        what = "open the page in this machine's browser"
        self.add_argument("--open", action="store_true", help=what)

    def add_listen(
        self, default: float = LISTEN, what: str = "how long to listen to a live robot"
    ) -> None:
        """Add ``--for``, for commands that look once.

        Args:
            default: how long, where it is not given [s].
            what: its help.
        """
        self.add_argument(
            "--for",
            dest="listen",
            type=_seconds,
            default=default,
            metavar="SECONDS",
            help=f"{what} [s] (default: %(default)g)",
        )

    def error(self, message: str) -> NoReturn:
        """Exit with the message, the nearest flag, and how to get help."""
        unknown = re.match(r"unrecognized arguments: (--[\w-]+)", message)
        flags = [name for action in self._actions for name in action.option_strings]
        near = nearest(unknown[1], flags) if unknown else None
        elsewhere = {n for option in declared(Options) for n in flag_of(option).names}
        if unknown and unknown[1] in elsewhere:
            message = f"{unknown[1]} is a flag of other commands, not of this one"
            near = None
        meant = f"; did you mean {near}?" if near else ""
        if re.match(r"unrecognized arguments: .*\.(mcap|db3|bag)\b", message):
            meant = "; name each recording with --source FILE, a model with --model."
        help_is = f"{' ' if meant else '; '}see {self.prog} --help"
        self.exit(2, line(f"{self.prog}: error: {message}{meant}{help_is}") + "\n")


def parse(
    parser: Parser, words: Sequence[str], **fixed: Any
) -> tuple[argparse.Namespace, Options]:
    """Read a command line, which may have a MODEL and NAME:=VALUE words in it.

    Write warnings about odd, but accepted, values to standard error.

    Args:
        parser: of the command.
        words: the command line.
        fixed: options that the command sets itself.

    Returns:
        The command's own arguments, and the options.

    Raises:
        UsageError: a value is invalid, or there are two models.
        JointError: a joint state file that cannot be read.
    """
    rest: list[str] = []
    arguments: dict[str, str] = {}
    words, notes = without_ros_arguments(words)
    for note in notes:
        warn(note)
    for word in words:
        match = _ARGUMENT.fullmatch(word)
        if match:
            arguments[match[1]] = match[2].strip()
        else:
            # argparse would take the word that follows, such as the model, for a value.
            alone = parser.alone.get(word)
            rest.append(word if alone is None else f"{word}={alone}")
    launch_model = arguments.pop("model", None)
    by_word = [
        spelled
        for option in parser.options
        if (word := flag_of(option).word) in arguments
        for spelled in _as_flag(flag_of(option), arguments.pop(word))
    ]
    # A flag comes later than the word of the same option, and so it wins.
    given = parser.parse_args([*by_word, *rest])
    named = (given.model, given.model_option) if parser.takes_model else ()
    models = [m for m in (*named, launch_model) if m is not None]
    if models and not parser.takes_model:
        arguments["model"] = models[0]
    if arguments and not parser.takes_arguments:
        raise UsageError(
            f"{parser.prog} takes no NAME:=VALUE; see {parser.prog} --help"
        )
    takes_source = any(option.name == "source" for option in parser.options)
    # A model beside a recording; `Options` recognises a recording given alone.
    both = takes_source and len(models) > 1
    recorded = [m for m in models if both and is_recording(m)]
    models = [m for m in models if m not in recorded]
    if len(models) > 1:
        raise UsageError(f"two models given: '{models[0]}' and '{models[1]}'; name one")
    # Each value is parsed by the package of its subject, imported only when needed.
    found = [(option, getattr(given, option.name)) for option in parser.options]
    values = {o.name: _value(o, value) for o, value in found if value != []}
    model = models[0] if models else None
    if recorded:
        uris = [f"bag:{path}" for path in recorded]
        values["source"] = (*uris, *values.get("source", ()))
    options = Options(model=model, xacro_args=arguments, **values, **fixed)
    if options.source and not takes_source:
        raise UsageError(
            f"'{model}' is a recording, and {parser.prog} reads models; see what is in "
            "it with sambot-viz topics"
        )
    for transform in options.transforms:
        for warning in transform.warnings:
            warn(f"--static-transform: {warning}")
    return given, options


def _seconds(word: str) -> float:
    try:
        seconds = float(word)
    except ValueError:
        seconds = 0.0
    if not 0.0 < seconds <= LONGEST_LISTEN:
        raise argparse.ArgumentTypeError(
            f"{word} is not a time from above 0 to {LONGEST_LISTEN:g} seconds"
        )
    return seconds


def model_path(options: Options) -> Path | None:
    """Return the MODEL of a command line; None for the bundled robot."""
    return Path(str(options.model)) if options.model is not None else None


def config_path(options: Options) -> Path | None:
    """Return the .rviz file of a command line, if there is one."""
    return Path(str(options.config)) if options.config is not None else None


def output_path(text: str, what: str, *endings: str) -> Path:
    """Return the file of ``-o``.

    Args:
        text: as the user wrote it.
        what: the thing to write, for the message.
        endings: the endings of such files, the usual one first.

    Raises:
        UsageError: another ending, a folder, or a folder that does not exist.
    """
    path = Path(text)
    if path.suffix.lower() not in endings:
        name = f"FILE{endings[0]}"
        raise UsageError(f"-o {text}: only {what} can be written; name it {name}")
    if path.is_dir():
        raise UsageError(f"-o {text} is a folder; name a file in it")
    if not path.parent.is_dir():
        raise UsageError(f"-o {text}: the folder '{path.parent}' does not exist")
    return path


def drawing_format(path: Path, formats: Mapping[str, T]) -> T:
    """Return the format that a drawing's file name ends in.

    Raises:
        UsageError: no format has this ending.
    """
    found = formats.get(path.suffix.lower())
    if found is None:
        raise UsageError(
            f"-o {path}: the format comes from the ending, which must be one of "
            f"{', '.join(formats)}; "
            "for a PDF, write a .dot file and convert it with dot -Tpdf"
        )
    return found


def write_drawing(path: Path | None, drawing: str) -> None:
    """Write a drawing into a file; None writes it to standard output.

    Raises:
        UsageError: the file cannot be written.
    """
    if path is None:
        write_lines(drawing)
        return
    try:
        path.write_text(drawing, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"cannot write '{path}': {error.strerror}") from error


def warn(text: str) -> None:
    """Write a warning about the command line to standard error."""
    write_err(f"sambot-viz: warning: {text}")


def _is_taken(flag: Flag, groups: Sequence[Group]) -> bool:
    return bool(flag.names) and flag.group in groups


def _add(parser: Parser, option: Field[Any]) -> None:
    flag = flag_of(option)
    default = option.default if flag.default is None else flag.default
    given: dict[str, Any] = {"dest": option.name}
    if flag.switch == "yes-no":
        given |= {"action": argparse.BooleanOptionalAction, "default": default}
    elif flag.switch == "off":
        given |= {"action": "store_false"}
    else:
        value = os.environ.get(flag.variable) or default
        given |= {"metavar": flag.metavar, "type": flag.type, "default": value}
        if flag.optional_value:
            given |= {"nargs": "?", "const": os.environ.get(flag.variable, "")}
        if flag.choices:
            given |= {"choices": flag.choices}
        if flag.read is not None:
            given |= {"action": "append", "default": []}
    action = parser.add_argument(*flag.names, **given)
    # Some versions of Python add their own words to the help of a switch.
    action.help = flag.help + _default_in_words(flag, default)


def _default_in_words(flag: Flag, default: object) -> str:
    if flag.switch == "yes-no":
        return " (default: yes)" if default else " (default: no)"
    if isinstance(default, str | int) and not flag.switch:
        return f" (default: {default})"
    return ""


def _as_flag(flag: Flag, value: str) -> list[str]:
    """Turn an argument of display.launch.py, such as ``gui:=false``, into flags."""
    name = flag.names[-1]
    if not flag.switch:
        return [f"{name}={value}"]
    if value.lower() not in (*_YES, *_NO):
        raise UsageError(f"{flag.word}:={value} is neither true nor false")
    return [name if value.lower() in _YES else f"--no-{name.removeprefix('--')}"]


def _value(option: Field[Any], given: Any) -> Any:
    flag = flag_of(option)
    return given if flag.read is None else flag.read(given, flag.names[-1])


def start_state(robot: Robot, options: Options) -> JointState:
    """Return the joint positions at the start; write warnings about doubtful ones.

    Raises:
        JointError: a joint that does not exist or cannot be set.
    """
    state = options.start_pose.state(robot)
    for name in options.start_pose.passed_over(state):
        warn(f"--joint-state: the robot has no joint '{name}'; ignored")
    for problem in state.problems:
        if problem.code == "mimic-joint-disagrees":
            warn(f"{problem.message}; {problem.hint}")
    return state


def posed_frames(robot: Robot, inputs: Inputs) -> FrameTree:
    """Return the frames as ROS has them, with the static transforms of the options.

    Raises:
        JointError: a joint that does not exist or cannot be set.
        FrameError: a static transform that would form a ring.
    """
    from sambot_viz.frames.robot_frames import robot_frames

    options, recorded = inputs.options, inputs.moved_by
    positions = start_state(robot, options)
    if recorded is None:
        tree = robot_frames(robot, positions.all_positions())
    else:
        tree = recorded.frames(robot, positions)
    for added in options.transforms:
        tree.set_static(added.parent, added.child, added.transform)
    return tree
