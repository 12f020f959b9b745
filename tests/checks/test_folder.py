"""A package folder is checked as a whole."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from manifests import written

from sambot_viz.cli import main

MODEL = """\
<robot name="r">
  <link name="base_link"/>
  <link name="wheel"/>
  <joint name="wheel_joint" type="continuous">
    <parent link="base_link"/>
    <child link="wheel"/>
  </joint>
</robot>
"""
CONFIG = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Name: RobotModel
  Global Options:
    Fixed Frame: base_lnk
"""


@pytest.fixture
def package(tmp_path: Path) -> Path:
    files = {
        "package.xml": "<package><name>my_bot</name></package>",
        "setup.py": "from setuptools import setup\nsetup(name='mybot')\n",
        "urdf/my_bot.urdf": MODEL,
        "rviz/my_bot.rviz": CONFIG,
    }
    return written(tmp_path / "my_bot", files)


def checked(folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, set[str]]:
    status = main(["check", str(folder), "--format", "json"])
    said = json.loads(capsys.readouterr().out)
    assert said["model"].endswith("my_bot.urdf")
    return status, {problem["code"] for problem in said["problems"]}


def test_model_config_and_setup_py_are_checked_together(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, codes = checked(package, capsys)
    assert status == 1
    assert {"setup-fixed-frame", "setup-py-name"} <= codes


def test_a_file_that_is_not_a_config_is_reported_with_the_rest(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (package / "rviz/my_bot.rviz").write_text("a: [\n")
    (package / "setup.py").unlink()
    status, codes = checked(package, capsys)
    assert status == 1
    assert any(code.startswith("config-") for code in codes)


def test_a_model_that_cannot_be_loaded_is_reported_with_the_rest(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = package / "urdf/my_bot.urdf"
    model.write_text(model.read_text().replace("</joint>", ""))
    status, codes = checked(package, capsys)
    assert status == 1
    assert {"xml-tag-not-closed", "setup-py-name"} <= codes


@pytest.mark.parametrize(
    ("file", "codes", "elsewhere"),
    [
        ("rviz/my_bot.rviz", {"setup-fixed-frame"}, 1),
        ("setup.py", {"setup-py-name"}, 1),
        ("package.xml", set[str](), 2),
    ],
)
def test_a_file_that_is_no_model_is_checked_with_its_package(
    package: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    file: str,
    codes: set[str],
    elsewhere: int,
) -> None:
    monkeypatch.chdir(package)
    main(["check", file, "--format", "json"])
    said = json.loads(capsys.readouterr().out)["problems"]
    assert {problem["code"] for problem in said} == codes
    assert {problem["file"] for problem in said} <= {file}
    main(["check", file])
    text = capsys.readouterr().out
    assert f"{elsewhere} more finding" in text
    assert text.endswith("sambot-viz check .\n")


def test_a_config_that_is_given_is_checked_against_the_robot(
    package: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = tmp_path / "other.rviz"
    config.write_text(CONFIG.replace("RobotModel\n      E", "RobotModl\n      E"))
    model = str(package / "urdf/my_bot.urdf")
    main(["check", model, "-d", str(config), "--format", "json"])
    found = json.loads(capsys.readouterr().out)["problems"]
    of_config = {p["code"]: p["edits"] for p in found if p["file"] == str(config)}
    assert of_config.keys() >= {"config-class", "setup-fixed-frame"}
    ((edit,),) = (of_config["setup-fixed-frame"],)
    assert edit["text"] == "base_link"
    # The package's own is checked too; one that is given is not checked twice.
    main(["check", model, "-d", str(package / "rviz/my_bot.rviz"), "--format", "json"])
    found = json.loads(capsys.readouterr().out)["problems"]
    assert [p["code"] for p in found].count("setup-fixed-frame") == 1
    main(["check", model, "-d", str(config), "--fix", "--yes"])
    assert "Fixed Frame: base_link" in config.read_text()
