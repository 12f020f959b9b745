"""What ROS and RViz take on a command line is taken here too, or it is said why not."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import pytest

from sambot_viz.commands.command_line import parse
from sambot_viz.commands.ros_arguments import without_ros_arguments
from sambot_viz.commands.show import parser
from sambot_viz.errors import UsageError
from sambot_viz.options import Options

TWO = ["/tf:=tf", "__ns:=/a"]
ROBOT = "foxglove://h:1"


def options(*words: str) -> tuple[argparse.Namespace, Options]:
    return parse(parser(), ["--source", ROBOT, *words])


@pytest.mark.parametrize(
    ("words", "rules"),
    [
        (["--ros-args", "-r", "scan:=/a/scan"], ["scan:=/a/scan"]),
        (
            ["--ros-args", "--remap", "/tf:=tf", "-r", "__ns:=/a"],
            ["/tf:=tf", "__ns:=/a"],
        ),
        (["--remap", "scan:=/a/scan"], ["scan:=/a/scan"]),
        (["--remap=/scan:=/b"], ["/scan:=/b"]),
        (["--ros-args", "-r", "a:=b", "--", "--no-watch"], ["a:=b"]),
    ],
)
def test_rules_are_taken(words: Sequence[str], rules: Sequence[str]) -> None:
    _, found = options(*words)
    assert list(found.remap) == rules


def test_what_has_no_meaning_is_said_once_each(
    capsys: pytest.CaptureFixture[str],
) -> None:
    _, found = options(
        "--ros-args",
        "-p",
        "use_sim_time:=true",
        "--param=rate:=1",
        "--log-level",
        "debug",
        "--disable-stdout-logs",
    )
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 4 and found.xacro_args == {}
    assert "/clock" in said[0] and "rate" in said[1]
    assert all(line.startswith("sambot-viz: warning: ") for line in said)


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--ros-args", "-r"], "-r needs a word"),
        (["--ros-args", "--fast"], "'--fast' is none of ROS's flags"),
    ],
)
def test_what_ros_refuses_is_refused(words: Sequence[str], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        without_ros_arguments(words)


def test_a_word_that_is_no_rule_is_refused() -> None:
    with pytest.raises(UsageError, match="is no rule"):
        options("--remap", "scan")


def test_flags_that_only_rviz_has_a_use_for_are_taken() -> None:
    given, found = options("--fullscreen", "-t", "{A}", "-l", "-s", "a.png")
    assert found.fullscreen and given.ogre_log and given.splash_screen == "a.png"
    assert given.display_title_format == "{A}"
