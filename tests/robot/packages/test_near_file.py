"""A path at which there is no file names the one that was meant, with its edit."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

MESHES = "wheels/left_tire.dae", "wheels/right_tire.dae", "base.dae", "d405.dae"
CMAKE = "install(DIRECTORY urdf meshes parts DESTINATION share/${PROJECT_NAME})\n"
MODEL = (
    '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '<xacro:include filename="$(find bot)/parts/arm/tool.xacro"/>\n'
    '<xacro:tool name="a"/>\n</robot>\n'
)
TOOL = (
    '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    '<xacro:macro name="tool" params="name">\n'
    '<link name="${{name}}"><visual><geometry>\n<mesh filename="{}"/>\n'
    "</geometry></visual></link>\n</xacro:macro>\n</robot>\n"
)


@pytest.fixture
def bot(tmp_path: Path) -> Path:
    """A package with meshes that are installed where they are."""
    bot = tmp_path / "bot"
    for name in MESHES:
        (bot / "meshes" / name).parent.mkdir(parents=True, exist_ok=True)
        (bot / "meshes" / name).write_text("no mesh")
    for folder in ("urdf", "parts/arm"):
        (bot / folder).mkdir(parents=True)
    (bot / "package.xml").write_text("<package><name>bot</name></package>")
    (bot / "CMakeLists.txt").write_text(CMAKE)
    (bot / "urdf" / "r.urdf.xacro").write_text(MODEL)
    (bot / "parts" / "arm" / "tool.xacro").write_text(
        TOOL.format("package://bot/meshes/base.dae")
    )
    return bot


def mended(bot: Path, file: str, wrong: str) -> str:
    """Give a file another text, and return what the edits of the finding make of it."""
    (bot / file).write_text(wrong)
    codes = ("mesh-not-found", "xacro-include-missing", "file-by-path-only")
    found = check(bot / "urdf" / "r.urdf.xacro")
    (problem,) = (p for p in found if p.code in codes or "letter-case" in p.code)
    assert {edit.file for edit in problem.edits} <= {problem.file}
    return apply_edits(problem.edits, wrong)


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("package://bot/meshes/wheel/left_tire.dae", "wheels/left_tire.dae"),
        ("package://bot/meshes/left_tire.dae", "wheels/left_tire.dae"),
        ("package://bot/meshes/wheels/left_tire.stl", "wheels/left_tire.dae"),
        ("package://bot/meshes/wheels/left-tire.dae", "wheels/left_tire.dae"),
        ("package://bot/meshes/wheels/left_tyre.dae", "wheels/left_tire.dae"),
        ("package://bot/meshes/wheels/left_tire", "wheels/left_tire.dae"),
        ("package://bot/meshes/Base.dae", "base.dae"),
        ("package://bot/wheels/left_tire.dae", "wheels/left_tire.dae"),
        ("package://meshes/base.dae", "base.dae"),
        ("bot/meshes/base.dae", "base.dae"),
    ],
)
def test_a_mesh_is_named_as_it_is_called(bot: Path, wrong: str, right: str) -> None:
    text = mended(bot, "parts/arm/tool.xacro", TOOL.format(wrong))

    assert text == TOOL.format(f"package://bot/meshes/{right}")


def test_what_xacro_writes_before_the_path_stays(bot: Path) -> None:
    wrong = TOOL.format("file://$(find bot)/mesh/base.dae")

    text = mended(bot, "parts/arm/tool.xacro", wrong)

    assert text == wrong.replace("/mesh/", "/meshes/")


@pytest.mark.parametrize(
    "name",
    [
        "meshes/wheels/mid_tire.dae",
        "meshes/d415.dae",
        "meshes/wheel.dae",
        "meshes/wheels/left_tire.png",
    ],
)
def test_a_file_that_is_only_alike_is_not_named(bot: Path, name: str) -> None:
    wrong = TOOL.format(f"package://bot/{name}")

    assert mended(bot, "parts/arm/tool.xacro", wrong) == wrong


@pytest.mark.parametrize(
    "wrong",
    [
        "$(find bot)/parts/arms/tool.xacro",
        "$(find bot)/parts/arm/tol.xacro",
        "$(find bot)/parts/arm/tool.urdf.xacro",
        "$(find bot)/parts/tool.xacro",
        "$(find bot)/arm/tool.xacro",
    ],
)
def test_an_include_is_named_as_the_file_is_called(bot: Path, wrong: str) -> None:
    text = MODEL.replace("$(find bot)/parts/arm/tool.xacro", wrong)

    assert mended(bot, "urdf/r.urdf.xacro", text) == MODEL


def test_a_relative_include_stays_relative(bot: Path) -> None:
    text = MODEL.replace("$(find bot)/parts/arm/tool.xacro", "{}")

    made = mended(bot, "urdf/r.urdf.xacro", text.format("tool.xacro"))

    assert made == text.format("../parts/arm/tool.xacro")


def test_a_folder_may_be_installed_as_another(bot: Path) -> None:
    (bot / "CMakeLists.txt").write_text("install(DIRECTORY parts/ DESTINATION share)")
    text = MODEL.replace("/parts/arm/", "/arm/")
    (bot / "urdf" / "r.urdf.xacro").write_text(text)

    assert "xacro-include-missing" not in [p.code for p in check(bot)]
