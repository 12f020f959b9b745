"""`sambot-viz config` says what of a file is shown."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sambot_viz.bundled import config_path
from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]


@pytest.fixture
def mixed(tmp_path: Path) -> Path:
    path = tmp_path / "mixed.rviz"
    path.write_text(
        "Visualization Manager:\n"
        "  Displays:\n"
        "    - {Class: rviz/Grid, Name: Ground, Enabled: true, Alpha: 7}\n"
        "    - {Class: my_plugins/Radar, Name: Radar, Enabled: true, Gain: 3}\n"
    )
    return path


def test_a_table_lists_what_is_shown_and_what_is_only_kept(
    mixed: Path, capsys: Capture
) -> None:
    assert main(["config", str(mixed)]) == 0
    out = capsys.readouterr().out
    assert "Ground (rviz/Grid), on: shown" in out
    assert "Radar (my_plugins/Radar), on: not supported" in out
    assert "2 displays, 1 of them not supported" in out


def test_the_report_can_be_json(mixed: Path, capsys: Capture) -> None:
    assert main(["config", str(mixed), "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [display["level"] for display in found["displays"]] == [
        "shown",
        "not supported",
    ]
    assert found["file"] == str(mixed)


def test_settings_of_links_are_not_unknown_keys(capsys: Capture) -> None:
    assert main(["config", str(config_path()), "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out)["counts"]["unknown key"] == 0


def test_a_file_that_is_not_a_config_is_reported(
    tmp_path: Path, capsys: Capture
) -> None:
    assert main(["config", str(tmp_path / "none.rviz")]) == 2
    assert "there is no such file" in capsys.readouterr().err
    broken = tmp_path / "broken.rviz"
    broken.write_text("Visualization Manager: [")
    assert main(["config", str(broken)]) == 1
    assert "error[config-yaml]" in capsys.readouterr().err
