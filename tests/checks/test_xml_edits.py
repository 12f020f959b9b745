"""What is not XML carries the edit that makes it XML."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.edits import apply_edits

INERTIA = '<inertial><mass value="1"/><inertia {}/></inertial>'


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ('<link name="a>\n</link>', '<link name="a">\n</link>'),
        ('<link name="a"\n</link>', '<link name="a">\n</link>'),
        ('<link name="a"\n<!-- b -->', '<link name="a"/>\n<!-- b -->'),
        ("<link name=a/>", '<link name="a"/>'),
        ('<link name=a"/>', '<link name="a"/>'),
        ("<link name=“a”/>", '<link name="a"/>'),
        ('<link name="a"type=""/>', '<link name="a" type=""/>'),
        ('<link name="a"/> & more', '<link name="a"/> &amp; more'),
        ('<!-- a -- b --><link name="a"/>', '<!-- a - b --><link name="a"/>'),
        ('<link name="a" name="a"/>', '<link name="a"/>'),
        (
            '<link name="a">\n<visaul><geometry><sphere radius="1"/></geometry>'
            "</visual>\n</link>",
            '<link name="a">\n<visaul><geometry><sphere radius="1"/></geometry>'
            "</visaul>\n</link>",
        ),
        ('<link name="a"></Link>', '<link name="a"></link>'),
        (
            '<link name="a">\n  <visual>\n    <geometry><sphere radius="1"/>\n'
            "    </geometry>\n</link>",
            '<link name="a">\n  <visual>\n    <geometry><sphere radius="1"/>\n'
            "    </geometry>\n  </visual>\n</link>",
        ),
        (
            '<link name="a"><visual><geometry><sphere radius="1"></geometry>'
            "</visual></link>",
            '<link name="a"><visual><geometry><sphere radius="1"/></geometry>'
            "</visual></link>",
        ),
        (
            '<link name="a">\n<visual><geometry><sphere radius="1"/></geometry>'
            "\n</link>\n</visual>",
            '<link name="a">\n<visual><geometry><sphere radius="1"/></geometry>'
            "\n</visual>\n</link>",
        ),
        ('<link name="a"/></link>', '<link name="a"/>'),
        (
            '<link name="a"><visual><sphere radius="1"/></geometry></visual></link>',
            '<link name="a"><visual><geometry><sphere radius="1"/></geometry></visual>'
            "</link>",
        ),
        (
            '<link name="a"><visual/></link><joint><child link="b"/></joint>\n'
            "<visual/>\n</link>",
            '<link name="a"><visual/></link><joint><child link="b"/></joint>\n'
            '<link name="b"><visual/>\n</link>',
        ),
        ('<link name="a"/></robot>\n<material name="m"/>', None),
        (
            f'<link name="a">{INERTIA}</link>'.format(
                'ixx="1" ixy="0" ixz="0" ixx="1" iyz="0" izz="1"'
            ),
            f'<link name="a">{INERTIA}</link>'.format(
                'ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"'
            ),
        ),
    ],
)
def test_the_edit_of_what_is_no_xml_makes_it_xml(
    wrong: str, right: str | None, tmp_path: Path
) -> None:
    model = tmp_path / "r.urdf"
    text = f'<robot name="r">\n{wrong}\n</robot>\n'
    model.write_text(text, "utf-8")
    (problem,) = check(model)
    assert problem.code.startswith("xml-")
    better = apply_edits(problem.edits, text)
    if right is not None:
        assert better == f'<robot name="r">\n{right}\n</robot>\n'
    model.write_text(better, "utf-8")
    assert not [one for one in check(model) if one.code.startswith("xml-")]


@pytest.mark.parametrize(
    "inside",
    [
        '<link name="a">{}</link>\n{}\n</link>'.format(*[INERTIA.format("")] * 2),
        '<link name="a"><visual/></link>\n<joint/>\n<visual/>\n</link>',
        '<joint name="j"></joint>\n<link name="a"/>\n<parent link="a"/>\n</joint>',
    ],
)
def test_two_elements_are_not_joined_where_an_opening_tag_is_missing(
    inside: str, tmp_path: Path
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(f'<robot name="r">\n{inside}\n</robot>\n', "utf-8")
    (problem,) = check(model)
    assert problem.code == "xml-closing-tag-surplus"
    assert 'name="…"' in problem.hint
    assert not problem.edits


def test_a_file_without_its_last_line_gets_it(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    text = '<robot name="r">\r\n<link name="a"/>\r\n'
    model.write_bytes(text.encode())
    (problem,) = check(model)
    better = apply_edits(problem.edits, text)
    assert better == '<robot name="r">\r\n<link name="a"/>\r\n</robot>\r\n'
