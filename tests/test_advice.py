"""Edits that come from hints: what a hint says to write is written."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.advice import with_edits
from sambot_viz.edits import apply_edits
from sambot_viz.errors import Problem


def edited(folder: Path, text: str, hint: str, line: int, column: int | None) -> str:
    """The text of a file after the edits of a hint."""
    file = folder / "robot.urdf"
    file.write_text(text, "utf-8")
    problem = Problem("error", "code", "message", hint, str(file), line, column)
    (found,) = with_edits([problem])
    return apply_edits(found.edits, text)


@pytest.mark.parametrize(
    ("text", "hint", "right"),
    [
        ('<box size="1"/>', 'write size="1 1 1"', '<box size="1 1 1"/>'),
        ("<box/>", 'write size="1 1 1"', '<box size="1 1 1"/>'),
        (
            '<limit lower="1">',
            'add effort="10" velocity="1", or delete <limit>',
            '<limit lower="1" effort="10" velocity="1">',
        ),
        ('<robot id="r">', 'write <robot name="a">', '<robot id="r" name="a">'),
        ('<a x="1" y="2"/>', "delete x", '<a y="2"/>'),
        ("<m>1,5</m>", "write 1.5", "<m>1.5</m>"),
        ('<mass value="2"/>', "write <mass>2</mass>", "<mass>2</mass>"),
        ('<color rgba="1"/>', "write <a>1</a> and <b>1</b>", "<a>1</a><b>1</b>"),
        ("<axis/>", "write <xyz>0 0 1</xyz> into it", "<axis><xyz>0 0 1</xyz></axis>"),
        (
            "<joint>\n  <child/>\n</joint>",
            'add <limit lower="0"/> with lower in metres, or make it fixed',
            '<joint>\n  <child/>\n  <limit lower="0"/>\n</joint>',
        ),
        ("<a>\n  <b/>\n</a>", "add <c/> before it", "<c/><a>\n  <b/>\n</a>"),
    ],
)
def test_a_hint_is_an_edit_of_the_element_at_its_place(
    text: str, hint: str, right: str, tmp_path: Path
) -> None:
    assert edited(tmp_path, text, hint, 1, 1) == right


def test_an_element_is_deleted_with_its_line(tmp_path: Path) -> None:
    text = "<a>\n  <b>1</b>\n</a>"
    assert edited(tmp_path, text, "delete it", 2, 3) == "<a>\n</a>"


def test_an_element_around_the_place_gets_an_attribute(tmp_path: Path) -> None:
    text = '<model name="m">\n  <link name="a"/>\n</model>'
    hint = 'write <model name="m" canonical_link="b">, or move b to the top'
    right = text.replace('"m"', '"m" canonical_link="b"')
    assert edited(tmp_path, text, hint, 2, 3) == right


def test_an_attribute_on_a_line_of_its_own_is_found(tmp_path: Path) -> None:
    text = '<box\n  size="1"/>'
    hint = 'write size="1 1 1"'
    assert edited(tmp_path, text, hint, 2, None) == '<box\n  size="1 1 1"/>'


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (
            '<link name="left wheel"/>',
            'write name="left_wheel", and so on',
        ),
        ('<box size="${x}"/>', 'write size="1 1 1"'),
        ("<m>${m}</m>", "write 1.5"),
        ("<joint/>", 'write <parent link="…"/> into it'),
        ("<joint><limit/></joint>", "write <limit>1</limit> inside <axis>"),
        ("<inertial/>", "write <mass>1</mass>"),
        ("<a><b/></a>", "write <a>1</a>"),
        ("<a/>", "delete it, or write what it means"),
        ("no element", 'write size="1 1 1"'),
    ],
)
def test_a_hint_that_is_not_certain_stays_one(
    text: str, hint: str, tmp_path: Path
) -> None:
    assert edited(tmp_path, text, hint, 1, 1) == text


def test_only_xml_has_tags(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("- <space>one\n- <space>two\n")
    problem = Problem("warning", "c", "m", "write one", str(file), 1, 3)
    assert with_edits([problem])[0].edits == ()
