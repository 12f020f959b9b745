"""`sambot-viz snapshot` refuses early what cannot become a picture."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "a.jpg"], "only PNG files can be written"),
        (["-o", "no/such/folder/a.png"], "the folder 'no/such/folder' does not exist"),
        (["-o", "a.png", "--size", "big"], "not a size in pixels, such as 800x600"),
        (["-o", "a.png", "--size", "0x600"], "each side must be 1 to 8,192 pixels"),
        (["-o", "a.png", "--size", "9000x6"], "each side must be 1 to 8,192 pixels"),
        (["-o", "a.png", "--joint", "left"], "--joint"),
        (["-o", "a.png", "--joint", "left=nan"], "--joint"),
        (["-o", "a.png", "--static-transform", "1 2"], "--static-transform"),
        (["-o", "a.png", "-f", ""], "the fixed frame has an empty name"),
        (["-o", "a.png", "nowhere.urdf"], "no model 'nowhere.urdf'"),
        (["-o", "a.png", "-d", "nowhere.rviz"], "no config 'nowhere.rviz'"),
    ],
)
def test_a_line_that_makes_no_sense_ends_with_2(
    words: Sequence[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["snapshot", *words]) == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_joint_is_reported_before_a_browser_is_looked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setenv("SAMBOT_VIZ_BROWSER", str(tmp_path / "no-such-browser"))
    file = str(tmp_path / "a.png")
    assert main(["snapshot", "-o", file, "--joint", "drivewhl_l_jont=1"]) == 1
    assert "did you mean 'drivewhl_l_joint'" in capsys.readouterr().err


def test_without_a_browser_it_says_how_to_get_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setenv("SAMBOT_VIZ_BROWSER", str(tmp_path / "no-such-browser"))
    assert main(["snapshot", "-o", str(tmp_path / "a.png")]) == 1
    assert "SAMBOT_VIZ_BROWSER" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_fixed_frame_that_does_not_exist_is_reported_with_those_that_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    # The report comes before the browser, so that this test needs none.
    monkeypatch.setenv("SAMBOT_VIZ_BROWSER", str(tmp_path / "no-such-browser"))
    model = tmp_path / "r.urdf"
    model.write_text('<robot name="r"><link name="hull"/></robot>')
    main(["snapshot", str(model), "-o", str(tmp_path / "a.png"), "-f", "odom"])
    err = capsys.readouterr().err
    assert "Frame [odom] does not exist; existing frames: hull\n" in err
    main(["snapshot", str(model), "-o", str(tmp_path / "a.png")])
    assert "does not exist" not in capsys.readouterr().err
