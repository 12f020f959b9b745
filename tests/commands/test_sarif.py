"""`sambot-viz check --format sarif` writes what the SARIF 2.1.0 standard asks for."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from sambot_viz import check
from sambot_viz.cli import main
from sambot_viz.commands.sarif import sarif_log
from sambot_viz.errors import Edit, Problem
from sambot_viz.explanations import as_text

Capture = pytest.CaptureFixture[str]
WRONG = (
    '<robot name="r">\r\n<!-- ä -->\r\n<link name="a">\r\n'
    "  <visaul><geometry><box size='1 1 1'/></geometry></visaul></link>\r\n</robot>"
)


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = Path("my robots/r.urdf")
    path.parent.mkdir()
    path.write_bytes(WRONG.encode())
    return path


def logged(model: Path, capsys: Capture) -> dict[str, Any]:
    main(["check", "--format", "sarif", str(model)])
    return json.loads(capsys.readouterr().out)


def test_a_log_has_a_run_with_the_tool_and_its_rules(
    model: Path, capsys: Capture
) -> None:
    log = logged(model, capsys)
    assert log["version"] == "2.1.0"
    (run,) = log["runs"]
    assert run["columnKind"] == "unicodeCodePoints"
    driver = run["tool"]["driver"]
    assert driver["name"] == "sambot-viz" and driver["version"]
    assert [rule["id"] for rule in driver["rules"]] == ["element-misspelt"]
    assert driver["rules"][0]["shortDescription"] == {"text": "Element misspelt"}
    assert driver["rules"][0]["help"] == {"text": as_text("element-misspelt")}


def test_a_result_is_at_its_line_with_its_hint(model: Path, capsys: Capture) -> None:
    (result,) = logged(model, capsys)["runs"][0]["results"]
    (problem,) = check(model)
    assert (result["ruleId"], result["ruleIndex"]) == ("element-misspelt", 0)
    assert result["level"] == "warning"
    assert result["message"]["text"] == f"{problem.message}; {problem.hint}"
    assert [place["physicalLocation"] for place in result["locations"]] == [
        {
            "artifactLocation": {
                "uri": "my%20robots/r.urdf",
                "uriBaseId": "%SRCROOT%",
            },
            "region": {"startLine": 4, "startColumn": 3},
        }
    ]


def test_edits_are_replacements(model: Path, capsys: Capture) -> None:
    (result,) = logged(model, capsys)["runs"][0]["results"]
    (fix,) = result["fixes"]
    assert fix["description"]["text"] == "write <visual …> and </visual>"
    (change,) = fix["artifactChanges"]
    assert change["artifactLocation"]["uri"] == "my%20robots/r.urdf"
    text = model.read_bytes().decode()
    lines = text.split("\n")
    for replacement in change["replacements"]:
        assert replacement["insertedContent"] == {"text": "visual"}
        region = replacement["deletedRegion"]
        start = region["charOffset"]
        assert text[start : start + region["charLength"]] == "visaul"
        assert region["startLine"] == region["endLine"] == 4
        line = lines[region["startLine"] - 1]
        assert line[region["startColumn"] - 1 : region["endColumn"] - 1] == "visaul"


def test_a_result_has_a_place_whatever_the_problem_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    gone = Edit("gone.urdf", 0, 1, "x")
    problems = [
        Problem("info", "b", "nowhere"),
        Problem("error", "a", "no line", "do it", "/elsewhere/a b.urdf", edits=(gone,)),
    ]
    (run,) = sarif_log(problems, Path("r.urdf"))["runs"]
    first, second = run["results"]
    assert [rule["id"] for rule in run["tool"]["driver"]["rules"]] == ["a", "b"]
    assert (first["level"], first["ruleIndex"]) == ("error", 0)
    assert (second["level"], second["ruleIndex"]) == ("note", 1)
    assert first["locations"] == [
        {
            "physicalLocation": {
                "artifactLocation": {"uri": "file:///elsewhere/a%20b.urdf"}
            }
        }
    ]
    assert "fixes" not in first
    place = second["locations"][0]["physicalLocation"]["artifactLocation"]
    assert place == {"uri": "r.urdf", "uriBaseId": "%SRCROOT%"}


def test_a_right_model_has_no_results(model: Path, capsys: Capture) -> None:
    model.write_text(WRONG.replace("visaul", "visual"))
    assert logged(model, capsys)["runs"][0]["results"] == []
    assert main(["check", "--format", "sarif", str(model)]) == 0
