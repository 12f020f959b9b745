"""The tutorial, docs/first-robot.md, walked from an empty folder."""

from __future__ import annotations

import re
import shlex
import urllib.request
from pathlib import Path

import pytest
from docs_parts import first_robot
from docs_parts.command_line_page import parser_of
from docs_parts.first_robot import PAGE, Trial, Walk, agrees, changed, write_files
from program import address, serving

from sambot_viz import load_robot
from sambot_viz.cli import COMMANDS
from sambot_viz.displays.robot_model.robot_properties import ROBOT_MODEL_PROPERTIES
from sambot_viz.rviz import GroupProperty

WALK = Walk(PAGE.read_text("utf-8"))
OPENS = [pytest.param(t, id=f"line {t.line}") for t in WALK.trials if t.shows]


@pytest.mark.parametrize("trial", OPENS)
def test_each_command_that_opens_the_page_opens_it(
    trial: Trial, tmp_path: Path
) -> None:
    write_files(trial.files, tmp_path)
    words = shlex.split(trial.commands[0])[1:]
    with serving(*words, "--port", "0", cwd=tmp_path) as program:
        with urllib.request.urlopen(address(program)) as page:
            assert page.status == 200


def test_each_picture_is_made_by_a_command_that_is_accepted() -> None:
    pictures = [t for t in WALK.trials if t.said is None and not t.shows]
    assert len(pictures) > 5
    for trial in pictures:
        assert trial.picture
        parser_of(trial.command).parse_args(shlex.split(trial.commands[0])[2:])


def test_each_mistake_is_quoted() -> None:
    text = PAGE.read_text("utf-8")
    mistakes = re.findall(r"^```diff$", text, re.MULTILINE)
    quoted = [trial for trial in WALK.trials if trial.quoted]
    assert len(quoted) >= len(mistakes) > 20
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


def test_each_picture_of_the_tutorial_is_made_by_its_command() -> None:
    embedded = re.findall(r"first_robot_(\w+\.\w+)\)", PAGE.read_text("utf-8"))
    made = [trial.picture for trial in WALK.trials if trial.picture]
    assert embedded == ["body.png", *made]


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
