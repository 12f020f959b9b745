"""docs/command-line.md, from the parsers of the commands."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Iterator

from sambot_viz.cli import COMMANDS
from sambot_viz.commands.command_line import Parser

_HEAD = """\
# The command line

This page is generated; `sambot-viz COMMAND --help` says the same.

MODEL is a URDF, SDF or xacro file, whatever its ending, or a package folder; without
one, the bundled sam_bot is used. `NAME:=VALUE` is an argument for xacro, anywhere on
the line; `model:=`, `rvizconfig:=` and `gui:=` mean the same as for
`display.launch.py`.
"""


def page() -> str:
    """The whole page."""
    return "\n".join([_HEAD, *(_section(name) for name in ("show", *COMMANDS))])


def parser_of(command: str) -> Parser:
    """The parser of a command; "show" is the command without a name."""
    module = importlib.import_module(f"sambot_viz.commands.{command}")
    parser: Parser = module.parser()
    return parser


def _section(command: str) -> str:
    parser = parser_of(command)
    rows = "\n".join(_rows(parser))
    return (
        f"## {parser.prog}\n\n{parser.description}\n\n"
        f"| argument | meaning |\n| --- | --- |\n{rows}\n"
    )


def _rows(parser: Parser) -> Iterator[str]:
    for action in parser.actions:
        if "--help" in action.option_strings:
            continue
        help_text = (action.help or "") % {"default": action.default}
        if action.choices:
            help_text = f"{help_text}; " if help_text else ""
            help_text += " or ".join(f"`{choice}`" for choice in action.choices)
        yield f"| {_argument(action)} | {_escaped(help_text)} |"


def _argument(action: argparse.Action) -> str:
    value = "" if action.nargs == 0 else action.metavar or action.dest.upper()
    if action.nargs == "?":
        value = f"[{value}]"
    if not action.option_strings:
        return f"`{value}`"
    return ", ".join(
        f"`{name} {value}`".replace(" `", "`") for name in action.option_strings
    )


def _escaped(text: str) -> str:
    return text.replace("|", "\\|")
