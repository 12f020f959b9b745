"""``sambot-viz frames``: the tree as SVG, DOT and JSON."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import pytest

from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]


def test_the_ending_of_the_file_decides_the_format(tmp_path: Path) -> None:
    for ending in ("svg", "dot", "json"):
        assert main(["frames", "-o", str(tmp_path / f"tree.{ending}")]) == 0
    picture = (tmp_path / "tree.svg").read_text("utf-8")
    assert ElementTree.fromstring(picture).tag.endswith("svg")
    assert "drivewhl_l_joint" in picture
    assert (tmp_path / "tree.dot").read_text("utf-8").startswith("digraph frames {")
    drawn = json.loads((tmp_path / "tree.json").read_text("utf-8"))
    assert drawn["roots"] == ["base_link"]
    wheel = next(t for t in drawn["transforms"] if t["child"] == "drivewhl_l_link")
    assert (wheel["joint"], wheel["type"]) == ("drivewhl_l_joint", "continuous")


def test_without_a_file_the_dot_text_is_printed(capsys: Capture) -> None:
    assert main(["frames", "--static-transform", "0 0 1 0 0 0 map base_link"]) == 0
    out = capsys.readouterr().out
    assert '"map" -> "base_link" [label="static transform' in out


def test_another_ending_is_a_usage_error_that_says_how_to_get_a_pdf(
    tmp_path: Path, capsys: Capture
) -> None:
    assert main(["frames", "-o", str(tmp_path / "tree.pdf")]) == 2
    assert "dot -Tpdf" in capsys.readouterr().err


def test_a_file_that_cannot_be_written_is_reported(
    tmp_path: Path, capsys: Capture
) -> None:
    assert main(["frames", "-o", str(tmp_path / "none" / "tree.svg")]) == 2
    assert "cannot write" in capsys.readouterr().err
