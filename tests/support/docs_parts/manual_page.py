"""docs/sambot-viz.1, the manual page, from the parsers of the commands."""

from __future__ import annotations

from collections.abc import Iterator

from docs_parts.command_line_page import parser_of
from sambot_viz.cli import COMMANDS
from sambot_viz.commands.command_line import Parser
from sambot_viz.flags import declared, flag_of
from sambot_viz.options import Options

_HEAD = r""".\" Made by tests/support/docs.py
.TH SAMBOT\-VIZ 1
.SH NAME
sambot\-viz \- show a URDF, SDF or xacro robot in the browser
.SH SYNOPSIS
.B sambot\-viz
.RI [ MODEL ]
.RI [ FLAG ...]
.RI [ NAME := VALUE ...]
.br
.B sambot\-viz
.I COMMAND
.RI [ FLAG ...]
.SH DESCRIPTION
MODEL is a URDF, SDF or xacro file, whatever its ending, or a package folder; without
one, the bundled sam_bot is used. NAME:=VALUE is an argument for xacro, anywhere on the
line; model:=, rvizconfig:= and gui:= mean the same as for display.launch.py.
.SH COMMANDS
"""
_TAIL = r""".SH EXIT STATUS
0: fine. 1: errors were found. 2: a command line that makes no sense.
3: an internal error.
"""


def page() -> str:
    """The whole page."""
    sections = "".join(_section(name) for name in ("show", *COMMANDS))
    return f"{_HEAD}{sections}{_environment()}{_TAIL}"


def _section(command: str) -> str:
    parser = parser_of(command)
    entries = "".join(_entries(parser))
    return f".SS {_roff(parser.prog)}\n{_roff(parser.description or '')}\n{entries}"


def _entries(parser: Parser) -> Iterator[str]:
    for action in parser.actions:
        value = "" if action.nargs == 0 else str(action.metavar or action.dest.upper())
        value = f"[{value}]" if action.nargs == "?" else value
        names = [f"{name} {value}".strip() for name in action.option_strings]
        about = (action.help or "") % {"default": action.default}
        if action.choices:
            about = f"{about}: {' or '.join(map(str, action.choices))}"
        yield f".TP\n.B {_roff(', '.join(names) or value)}\n{_roff(about)}\n"


def _environment() -> str:
    flags = [flag_of(each) for each in declared(Options)]
    entries = "".join(
        f".TP\n.B {flag.variable}\nThe value of {_roff(flag.names[-1])}.\n"
        for flag in flags
        if flag.variable
    )
    browser = ".TP\n.B SAMBOT_VIZ_BROWSER\nThe Chromium or Chrome for pictures.\n"
    return f".SH ENVIRONMENT\n{entries}{browser}"


def _roff(text: str) -> str:
    text = text.replace("\\", r"\e").replace("-", r"\-").replace('"', r"\(dq")
    return rf"\&{text}" if text[:1] in (".", "'") else text
