"""``sambot-viz completion``: the words that a shell offers after the Tab key."""

from __future__ import annotations

import argparse
import importlib
import pkgutil
import re
import shlex
from collections.abc import Callable, Iterable

from sambot_viz import commands
from sambot_viz.commands.command_line import Parser
from sambot_viz.outlet import write_lines

_FOLDERS, _FILES = ("DIR",), ("FILE", "PATH", "MODEL")
"""Beginnings of the placeholders whose values are files."""


def run(words: list[str]) -> int:
    """Print the script for a shell."""
    given = parser().parse_args(words)
    write_lines(_SCRIPTS[given.shell](_all_parsers()))
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz completion",
        description="Print what completes the commands and flags of sambot-viz with "
        "the Tab key. In bash: source <(sambot-viz completion bash). In zsh, after "
        "compinit: source <(sambot-viz completion zsh). In fish: sambot-viz "
        "completion fish | source",
    )
    shells = tuple(_SCRIPTS)
    made.add_argument("shell", choices=shells, help="the shell that it is for")
    return made


def _all_parsers() -> dict[str, Parser]:
    """Return the parser of each command, first that of "show", which has no name."""
    names = sorted(found.name for found in pkgutil.iter_modules(commands.__path__))
    modules = {
        name: importlib.import_module(f"sambot_viz.commands.{name}")
        for name in sorted(names, key=lambda name: name != "show")
    }
    # Some modules here are used by commands but are no commands themselves.
    return {
        name: module.parser()
        for name, module in modules.items()
        if hasattr(module, "parser")
    }


def _flags(parser: Parser) -> list[argparse.Action]:
    return [action for action in parser.actions if action.option_strings]


def _names(parser: Parser) -> list[str]:
    return [name for action in _flags(parser) for name in action.option_strings]


def _value(action: argparse.Action) -> str:
    return str(action.metavar or action.dest.upper())


def _choices(action: argparse.Action) -> list[str]:
    return [str(choice) for choice in action.choices or ()]


def _help(action: argparse.Action) -> str:
    text = (action.help or "") % {"default": action.default}
    return text.partition(";")[0].partition(" (")[0]


def _about(parser: Parser) -> str:
    return re.split(r"[.:;,]\s|\.$", parser.description or "")[0]


def _bash(parsers: dict[str, Parser]) -> str:
    others = [name for name in parsers if name != "show"]
    values: list[str] = []
    for command, parser in parsers.items():
        for action in [a for a in _flags(parser) if a.nargs != 0]:
            case = "|".join(f'"{command} {name}"' for name in action.option_strings)
            values.append(f"        {case}) {_bash_value(action)}; return ;;")
    positional = [
        f'        {command}) words="{" ".join(_names(parser))}"'
        f' first="{" ".join(_first_words(parser))}" ;;'
        for command, parser in parsers.items()
    ]
    return _BASH.format(
        commands="|".join(others),
        offered=" ".join(others),
        values="\n".join(values),
        words="\n".join(positional),
    )


def _first_words(parser: Parser) -> Iterable[str]:
    """Yield the words that a command accepts in place of a file."""
    for action in parser.actions:
        if not action.option_strings:
            yield from _choices(action)


def _bash_value(action: argparse.Action) -> str:
    if action.choices:
        return f'_sambot_viz_offer -W "{" ".join(_choices(action))}"'
    if _value(action).startswith(_FOLDERS):
        return "_sambot_viz_offer -d"
    return "_sambot_viz_offer -f" if _value(action).startswith(_FILES) else ":"


_BASH = """\
# Completes sambot-viz in bash.
_sambot_viz_offer() {{
    [ "$1" = -W ] || compopt -o filenames 2>/dev/null
    mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen "$@" -- "$cur")
}}
_sambot_viz() {{
    local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}}
    local command=show words first
    COMPREPLY=()
    if [ "$cur" = "=" ]; then
        cur=
    elif [ "$prev" = "=" ]; then
        prev=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    if [ "$COMP_CWORD" -gt 1 ]; then
        case ${{COMP_WORDS[1]}} in {commands}) command=${{COMP_WORDS[1]}} ;; esac
    fi
    case "$command $prev" in
{values}
    esac
    case $command in
{words}
    esac
    case $cur in
        -*) _sambot_viz_offer -W "$words"; return ;;
    esac
    [ -n "$first" ] && {{ _sambot_viz_offer -W "$first"; return; }}
    [ "$COMP_CWORD" -gt 1 ] || _sambot_viz_offer -W "{offered}"
    _sambot_viz_offer -f
}}
complete -F _sambot_viz sambot-viz
"""


def _zsh(parsers: dict[str, Parser]) -> str:
    cases: list[str] = []
    for command, parser in parsers.items():
        if command != "show":
            lines = " \\\n            ".join(_zsh_arguments(parser, "*:file:_files"))
            begin = f"        {command})\n            shift words; (( CURRENT-- ))"
            cases.append(f"{begin}\n            _arguments {lines} ;;")
    show = " \\\n            ".join(
        _zsh_arguments(parsers["show"], "1: :_sambot_viz_first", "*:file:_files")
    )
    offered = " ".join(
        shlex.quote(f"{command}:{_about(parser)}")
        for command, parser in parsers.items()
        if command != "show"
    )
    return _ZSH.format(offered=offered, cases="\n".join(cases), show=show)


def _zsh_arguments(parser: Parser, *rest: str) -> list[str]:
    found: list[str] = []
    for action in _flags(parser):
        about = _help(action).replace("[", "(").replace("]", ")").replace(":", " ")
        value = ""
        if action.nargs != 0:
            # Optional arguments have two colons.
            colons = "::" if action.nargs == "?" else ":"
            value = (
                f"{colons}{_value(action).strip(chr(34) + '=')}:{_zsh_value(action)}"
            )
        found += [f"*{name}[{about}]{value}" for name in action.option_strings]
    words = list(_first_words(parser))
    places = [f"1:word:({' '.join(words)})"] if words else list(rest)
    return [shlex.quote(spec) for spec in (*found, *places)]


def _zsh_value(action: argparse.Action) -> str:
    if action.choices:
        return f"({' '.join(_choices(action))})"
    if _value(action).startswith(_FOLDERS):
        return "_files -/"
    return "_files" if _value(action).startswith(_FILES) else " "


_ZSH = """\
#compdef sambot-viz
# Completes sambot-viz in zsh.
_sambot_viz_first() {{
    local -a commands=({offered})
    _describe command commands
    _files
}}
_sambot-viz() {{
    local command=
    (( CURRENT > 2 )) && command=$words[2]
    case $command in
{cases}
        *)
            _arguments {show} ;;
    esac
}}
if [[ $funcstack[1] == _sambot-viz ]]; then
    _sambot-viz "$@"
else
    compdef _sambot-viz sambot-viz
fi
"""


def _fish(parsers: dict[str, Parser]) -> str:
    others = [name for name in parsers if name != "show"]
    no_other = f"not __fish_seen_subcommand_from {' '.join(others)}"
    lines = ["# Completes sambot-viz in fish."]
    for command, parser in parsers.items():
        when = no_other
        if command != "show":
            when = f"__fish_seen_subcommand_from {command}"
            lines.append(
                "complete -c sambot-viz -n __fish_use_subcommand "
                f"-a {command} -d {shlex.quote(_about(parser))}"
            )
        for action in _flags(parser):
            lines.append(_fish_line(action, when))
        if words := list(_first_words(parser)):
            lines.append(
                f"complete -c sambot-viz -n {shlex.quote(when)} -f "
                f"-a {shlex.quote(' '.join(words))}"
            )
    return "\n".join(lines) + "\n"


def _fish_line(action: argparse.Action, when: str) -> str:
    names = [
        f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}"
        for name in action.option_strings
    ]
    value = ""
    if action.choices:
        value = f" -x -a {shlex.quote(' '.join(_choices(action)))}"
    elif action.nargs is None:
        files = _value(action).startswith((*_FILES, *_FOLDERS))
        value = " -r" if files else " -x"
    about = shlex.quote(_help(action))
    return (
        f"complete -c sambot-viz -n {shlex.quote(when)} {' '.join(names)}"
        f"{value} -d {about}"
    )


_SCRIPTS: dict[str, Callable[[dict[str, Parser]], str]] = {
    "bash": _bash,
    "zsh": _zsh,
    "fish": _fish,
}
