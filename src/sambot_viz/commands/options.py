"""What the commands' lines have in common: the model, its arguments, clear errors."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from sambot_viz.errors import UsageError

if TYPE_CHECKING:
    from sambot_viz.robot.model import Robot

_ARGUMENT = re.compile(r"\s*([A-Za-z_][\w.-]*)\s*:=(.*)", re.DOTALL)


class Parser(argparse.ArgumentParser):
    """One clear line for a bad command line, instead of the whole usage."""

    def error(self, message: str) -> NoReturn:
        """Say what is wrong and where the help is."""
        self.exit(2, f"{self.prog}: error: {message}; see {self.prog} --help\n")


@dataclass(frozen=True)
class ModelOptions:
    """Which model is meant, and how it is read.

    Attributes:
        model: what was named, or None for the bundled robot.
        xacro_args: NAME:=VALUE words that are for xacro.
        package_path: folders in which ROS packages are looked for.
        trusted: whether xacro may do all that it can.
        words: NAME:=VALUE words that are for us (rvizconfig, gui).
    """

    model: Path | None
    xacro_args: dict[str, str] = field(default_factory=dict[str, str])
    package_path: Sequence[str] = ()
    trusted: bool = True
    words: dict[str, str] = field(default_factory=dict[str, str])

    def load(self, path: Path) -> Robot:
        """Read a model the way the command line asks for.

        Raises:
            RobotError: it cannot be shown.
        """
        from sambot_viz.robot.load import load_robot

        return load_robot(
            path,
            xacro_args=self.xacro_args,
            package_path=self.package_path,
            trusted=self.trusted,
        )


def add_model_options(parser: argparse.ArgumentParser) -> None:
    """The options that every command with a MODEL takes."""
    add = parser.add_argument
    add("model", nargs="?", metavar="MODEL", help="model file or package folder")
    add("--model", dest="model_option", metavar="PATH", help="the same, by name")
    add(
        "--package-path",
        action="append",
        default=[],
        metavar="DIR",
        help="a folder with ROS packages; may be given several times",
    )
    add(
        "--untrusted",
        action="store_true",
        help="take from xacro what a stranger's file could misuse",
    )
    add("--debug", action="store_true", help="show where a fault of ours comes from")


def parse(
    parser: argparse.ArgumentParser, words: Sequence[str], ours: Sequence[str] = ()
) -> tuple[argparse.Namespace, ModelOptions]:
    """Read a command line with a MODEL and NAME:=VALUE words anywhere in it.

    Args:
        parser: a parser with `add_model_options`.
        words: the command line.
        ours: NAMEs that are not for xacro, out of the launch file's habit.

    Raises:
        UsageError: two models.
    """
    rest: list[str] = []
    arguments: dict[str, str] = {}
    for word in words:
        match = _ARGUMENT.fullmatch(word)
        if match:
            arguments[match[1]] = match[2].strip()
        else:
            rest.append(word)
    options = parser.parse_args(rest)
    named = [options.model, options.model_option, arguments.pop("model", None)]
    given = [name for name in named if name is not None]
    if len(given) > 1:
        raise UsageError(f"two models given: '{given[0]}' and '{given[1]}'; name one")
    return options, ModelOptions(
        model=Path(given[0]) if given else None,
        words={name: arguments.pop(name) for name in ours if name in arguments},
        xacro_args=arguments,
        package_path=options.package_path,
        trusted=not options.untrusted,
    )
