"""Which model the tile shows."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.jupyter.__main__ import model_of

ARM = '<robot name="arm"><link name="a"/></robot>'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("one/arm.urdf", "two/leg.urdf", "two/hand.urdf"):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(ARM)
    return tmp_path


def test_the_model_in_the_folder_of_jupyterlab_is_shown(folder: Path) -> None:
    assert model_of(folder / "one", "") == folder / "one"


def test_a_teacher_names_a_file_or_a_folder(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert model_of(folder, "two/leg.urdf") == folder / "two/leg.urdf"
    assert model_of(Path("/"), str(folder / "one")) == folder / "one"
    monkeypatch.setenv("HOME", str(folder))
    assert model_of(Path("/"), "~/one") == folder / "one"


@pytest.mark.parametrize(
    ("place", "named", "why"),
    [
        ("two", "", "several models in the folder"),
        ("", "three", "SAMBOT_VIZ_MODEL: no model '"),
        ("one", "no.urdf", "SAMBOT_VIZ_MODEL: no model '"),
    ],
)
def test_otherwise_the_log_says_why_it_is_the_bundled_robot(
    folder: Path, capsys: pytest.CaptureFixture[str], place: str, named: str, why: str
) -> None:
    assert model_of(folder / place, named) is None
    said = capsys.readouterr().err
    assert said.startswith("sambot-viz: note: the bundled sam_bot is shown; ")
    assert why in said
