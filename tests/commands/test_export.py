"""`sambot-viz export` writes one file with everything in it."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]
HOSTILE = '</script><script>alert("x")</script><!--'


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["-o", "a.png"], "only a page can be written; name it FILE.html"),
        (["-o", "no/such/a.html"], "the folder 'no/such' does not exist"),
        (["-o", "a.html", "--joint", "left=nan"], "--joint"),
        (["-o", "a.html", "nowhere.urdf"], "no model 'nowhere.urdf'"),
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
    assert main(["export", *words]) == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_the_file_names_no_other_file_and_no_address(tmp_path: Path) -> None:
    file = tmp_path / "robot.html"
    assert main(["export", "-o", str(file)]) == 0
    page = file.read_text("utf-8")
    assert "<title>sam_bot</title>" in page[:1024]
    assert re.findall(r'(?:src|href)="(?!data:)[^"]*"', page) == []
    assert "default-src 'none'" in page[:1024]
    assert len(page) < 1_000_000
    assert [path.name for path in tmp_path.iterdir()] == ["robot.html"]


def test_a_name_that_is_html_stays_a_name(tmp_path: Path) -> None:
    escaped = HOSTILE.replace("<", "&lt;").replace('"', "&quot;")
    model, file = tmp_path / "r.urdf", tmp_path / "r.html"
    model.write_text(f'<robot name="{escaped}"><link name="a"/></robot>', "utf-8")
    assert main(["export", str(model), "-o", str(file)]) == 0
    page = file.read_text("utf-8")
    assert "alert(" in page
    assert 'script>alert("x")' not in page
    assert "<!--" not in page.partition("sambot-about")[2].partition("</script>")[0]


def test_without_a_motion_the_file_has_none(tmp_path: Path) -> None:
    still, moving = tmp_path / "still.html", tmp_path / "moving.html"
    assert main(["export", "-o", str(still), "--motion", "none"]) == 0
    assert main(["export", "-o", str(moving)]) == 0
    duration = re.compile(r'"duration": ([\d.]+)')
    times = [duration.findall(f.read_text("utf-8")) for f in (still, moving)]
    assert times == [["0.0"], ["6.0"]]
