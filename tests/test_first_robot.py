"""The tutorial, docs/first-robot.md, walked from an empty folder."""

from __future__ import annotations

import re
import shlex
import urllib.request
from pathlib import Path

import first_robot
import pytest
from command_line_page import parser_of
from first_robot import (
    PAGE,
    Trial,
    Walk,
    agrees,
    changed,
    graph_in,
    said_in,
    write_files,
)
from program import address, serving

from sambot_viz import load_robot
from sambot_viz.cli import COMMANDS
from sambot_viz.displays.robot_model.robot_properties import ROBOT_MODEL_PROPERTIES
from sambot_viz.export.browser_process import find_browser
from sambot_viz.rviz import GroupProperty

WALK = Walk(PAGE.read_text("utf-8"))
WALKED = [
    pytest.param(
        trial,
        id=f"line {trial.line}",
        marks=[pytest.mark.browser] * (trial.draws and trial.quoted),
    )
    for trial in WALK.trials
]


@pytest.mark.parametrize("trial", WALKED)
def test_each_command_of_the_tutorial_says_what_the_page_quotes(
    trial: Trial, tmp_path: Path
) -> None:
    if trial.draws and trial.quoted and find_browser() is None:
        pytest.skip("a snapshot needs a Chromium or Chrome on this machine")
    write_files(trial.files, tmp_path)
    if trial.shows:
        _open(trial, tmp_path)
        return
    if trial.said is None:
        # docs/make_pictures.py draws it.
        assert trial.picture
        parser_of(trial.command).parse_args(shlex.split(trial.commands[0])[2:])
        return
    now = said_in(tmp_path, trial)
    assert agrees(trial.said, now), (
        f"{PAGE.name} line {trial.line} quotes\n{trial.said}\nnow it is\n{now}\n"
        "run: PYTHONPATH=tests/support:src python tests/support/first_robot.py"
    )


def _open(trial: Trial, folder: Path) -> None:
    """Open the page as a reader does, at a free port."""
    words = shlex.split(trial.commands[0])[1:]
    with serving(*words, "--port", "0", cwd=folder) as program:
        with urllib.request.urlopen(address(program)) as page:
            assert page.status == 200


def test_each_mistake_is_quoted() -> None:
    text = PAGE.read_text("utf-8")
    mistakes = re.findall(r"^```diff$", text, re.MULTILINE)
    quoted = [trial for trial in WALK.trials if trial.quoted]
    assert len(quoted) >= len(mistakes) > 20
    assert not re.findall(r"^.*says:\n\n(?!>)", text, re.MULTILINE)
    for trial in quoted:
        assert trial.said and re.match(r"> `\S", trial.said)
        assert "no problems found" not in trial.said


def test_the_commands_and_settings_in_its_sentences_exist() -> None:
    text = PAGE.read_text("utf-8")
    named = {" ".join(c.split()) for c in re.findall(r"`(sambot-viz\b[^`]*)`", text)}
    assert len(named) > 10
    for command in named:
        name, *words = [*shlex.split(command)[1:], ""]
        kind = name if name in COMMANDS else "show"
        given = words if kind == name else [name, *words]
        # In the table of the beginning an option has no value yet.
        options = [word for word in given if word.startswith("-")]
        taken = parser_of(kind).format_help()
        assert all(option in taken for option in options), command
    groups = [p for p in ROBOT_MODEL_PROPERTIES if isinstance(p, GroupProperty)]
    settings = [*ROBOT_MODEL_PROPERTIES, *(c for g in groups for c in g.children)]
    known = {setting.name for setting in settings}
    for name in ("Visual Enabled", "Collision Enabled", "Mass Properties", "Balance"):
        assert name in text
        assert name in known


PICTURES = PAGE.parents[1] / ".github"


def test_each_picture_of_the_tutorial_is_made_by_its_command() -> None:
    """`docs/make_pictures.py` makes the pictures with these commands."""
    embedded = re.findall(r"first_robot_(\w+\.\w+)\)", PAGE.read_text("utf-8"))
    made = [trial.picture for trial in WALK.trials if trial.picture]
    assert embedded == ["body.png", *made]
    for name in embedded:
        assert (PICTURES / f"first_robot_{name}").is_file()


@pytest.mark.parametrize("trial", [t for t in WALK.trials if t.command == "graph"])
def test_each_graph_of_the_tutorial_is_what_its_command_draws_now(
    trial: Trial, tmp_path: Path
) -> None:
    write_files(trial.files, tmp_path)
    kept = (PICTURES / f"first_robot_{trial.picture}").read_text("utf-8")
    assert kept == graph_in(tmp_path, trial), "run: docs/make_pictures.py --graphs"


def test_both_files_are_the_same_robot(tmp_path: Path) -> None:
    write_files(WALK.files, tmp_path)
    urdf = load_robot(tmp_path / "sam_bot.urdf.xacro")
    sdf = load_robot(tmp_path / "sam_bot.sdf")
    turned = {"drivewhl_l_joint": 0.5}
    poses = sdf.forward_kinematics(turned)
    assert set(urdf.links) == set(sdf.links)
    for name, T_root_link in urdf.forward_kinematics(turned).items():
        assert abs(T_root_link - poses[name]).max() < 1e-9
    balance = urdf.balance()
    assert balance and balance.mass == pytest.approx(16.5)


def test_a_quotation_that_is_no_longer_true_is_found() -> None:
    assert agrees("$ a\nb\n…\n", "$ a\nb\nc\nd\n")
    assert not agrees("$ a\nb\n…\n", "$ a\nc\n")
    assert not agrees("> `old`\n", "> `new`\n")
    with pytest.raises(ValueError):
        changed("<link/>\n", "-<joint/>\n+<link/>\n")
    page = PAGE.read_text("utf-8")
    old = "did you mean 'base_laser'?"
    end = page.index("## 2.")
    assert first_robot.refreshed(page[:end].replace(old, "?")) == page[:end]
