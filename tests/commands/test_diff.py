"""``sambot-viz diff``: what differs between two models."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sambot_viz import bundled
from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]
SAM_BOT = bundled.model_path()


@pytest.fixture
def wider(tmp_path: Path) -> Path:
    text = SAM_BOT.read_text("utf-8")
    assert 'name="base_width" value="0.31"' in text
    file = tmp_path / "wider.urdf.xacro"
    file.write_text(
        text.replace('"base_width" value="0.31"', '"base_width" value="0.33"')
    )
    return file


def test_the_same_model_does_not_differ(capsys: Capture) -> None:
    assert main(["diff", str(SAM_BOT), str(SAM_BOT)]) == 0
    assert capsys.readouterr().out == "the models are the same\n"


def test_what_differs_is_a_table(capsys: Capture, wider: Path) -> None:
    assert main(["diff", str(SAM_BOT), str(wider)]) == 1
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == [str(SAM_BOT), str(wider)]
    assert [line.split("  ")[0] for line in lines] == [
        "link base_link: visual size",
        "joint drivewhl_l_joint: origin",
        "joint drivewhl_r_joint: origin",
    ]
    assert lines[0].split() == (
        "link base_link: visual size 420 310 180 mm 420 330 180 mm 20 mm".split()
    )


def test_json_has_metres_and_radians(capsys: Capture, wider: Path) -> None:
    assert main(["diff", "--format", "json", str(SAM_BOT), str(wider)]) == 1
    said = json.loads(capsys.readouterr().out)
    assert (said["mine"], said["theirs"]) == (str(SAM_BOT), str(wider))
    first = said["differences"][0]
    assert (first["kind"], first["name"]) == ("link", "base_link")
    assert (first["property"], first["unit"]) == ("visual size", "m")
    assert first["mine"] == [0.42, 0.31, 0.18]
    assert first["theirs"] == [0.42, 0.33, 0.18]
    assert first["apart"] == pytest.approx(0.02)
    assert first["line"] == first["their_line"]


def test_an_argument_is_for_both(capsys: Capture, tmp_path: Path) -> None:
    for name, size in (("a", "1 1 $(arg size)"), ("b", "1 1 2")):
        (tmp_path / f"{name}.xacro").write_text(
            '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
            '<xacro:arg name="size" default="1"/><link name="l"><visual><geometry>'
            f'<box size="{size}"/></geometry></visual></link></robot>'
        )
    files = [str(tmp_path / "a.xacro"), str(tmp_path / "b.xacro")]
    assert main(["diff", *files]) == 1
    assert main(["diff", *files, "size:=2"]) == 0


def test_a_broken_model_is_trouble_and_says_why(
    capsys: Capture, tmp_path: Path
) -> None:
    file = tmp_path / "r.urdf"
    file.write_text("<robot/>")
    assert main(["diff", str(SAM_BOT), str(file)]) == 2
    assert f"{file}:" in capsys.readouterr().err
    with pytest.raises(SystemExit) as stopped:
        main(["diff", str(SAM_BOT)])
    assert stopped.value.code == 2
