"""What shells offer after the Tab key is what the parsers take."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from docs_parts.command_line_page import parser_of

from sambot_viz.cli import COMMANDS, main

Complete = Callable[..., set[str]]
TRY_BASH = """
source "$1"; shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_sambot_viz
printf '%s\\n' "${COMPREPLY[@]}"
"""


def script(shell: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> Path:
    if shutil.which(shell) is None:
        pytest.skip(f"needs {shell}")
    assert main(["completion", shell]) == 0
    path = folder / f"completion.{shell}"
    path.write_text(capsys.readouterr().out, "utf-8")
    return path


@pytest.fixture(params=["bash", "fish"])
def complete(
    request: pytest.FixtureRequest, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> Complete:
    """What a shell offers for the last of some words: ``complete("check", "--")``."""
    shell = request.param
    path = script(shell, tmp_path, capsys)
    (tmp_path / "robot.urdf").touch()

    def offered(*words: str) -> set[str]:
        line = ["sambot-viz", *words]
        if shell == "bash":
            command = ["bash", "--norc", "-c", TRY_BASH, "bash", str(path), *line]
        else:
            try_fish = 'source $argv[1]; complete -C "$argv[2]"'
            command = ["fish", "-N", "-c", try_fish, str(path), " ".join(line)]
        done = subprocess.run(
            command, cwd=tmp_path, check=True, capture_output=True, text=True
        )
        assert done.stderr == ""
        return {text.partition("\t")[0] for text in done.stdout.split("\n") if text}

    return offered


def flags_of(command: str) -> set[str]:
    names = [
        name for each in parser_of(command).actions for name in each.option_strings
    ]
    return {name for name in names if name.startswith("--")}


def test_commands_and_models_come_first(complete: Complete) -> None:
    assert complete("") >= {*COMMANDS, "robot.urdf"}
    assert complete("chec") == {"check"}


@pytest.mark.parametrize("command", ["show", *COMMANDS])
def test_each_command_has_its_flags(complete: Complete, command: str) -> None:
    words = [] if command == "show" else [command]
    assert {word for word in complete(*words, "--") if word[:2] == "--"} == (
        flags_of(command)
    )


def test_values_are_offered(complete: Complete) -> None:
    assert complete("--session", "") == {"shared", "private"}
    assert complete("check", "--format", "j") == {"json"}
    assert complete("completion", "") >= {"bash", "zsh", "fish"}
    assert "robot.urdf" in complete("-d", "rob")
    assert "robot.urdf" in complete("check", "rob")
    assert complete("--port", "rob") == set()


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_is_one_of_its_shell(
    shell: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = script(shell, tmp_path, capsys)
    subprocess.run([shell, "-n", str(path)], check=True)


def test_zsh_is_told_all_flags(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", "zsh"]) == 0
    offered = set(re.findall(r"'\*(--[a-z-]+)\[", capsys.readouterr().out))
    assert offered == set().union(*map(flags_of, ("show", *COMMANDS)))
