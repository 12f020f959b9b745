from __future__ import annotations

import random

import pytest

from sambot_viz.errors import Problem
from sambot_viz.robot.xml.decode import XmlFault, decode
from sambot_viz.robot.xml.diagnose.explain_xml import explain_xml
from sambot_viz.robot.xml.element import parse_xml


def explained(text: str | bytes) -> list[Problem]:
    try:
        data = text.encode() if isinstance(text, str) else text
        parse_xml(decode(data), "r.urdf")
    except XmlFault as fault:
        return explain_xml(fault.text, "r.urdf", fault)
    return []


def only(text: str | bytes) -> Problem:
    problems = explained(text)
    assert len(problems) == 1, problems
    return problems[0]


ROBOT = '<?xml version="1.0"?>\n<robot name="r">\n{}</robot>\n'

CASES = [
    ("", "model-empty", 1, "empty"),
    ("  \n\n", "model-empty", 1, "empty"),
    ("version https://git-lfs.github.com/spec/v1\n", "model-lfs-pointer", 1, "LFS"),
    ("<!doctype html>\n<html></html>", "model-html-page", 1, "web page"),
    ('{"a": 1}', "model-not-xml", 1, "not XML"),
    (b"PK\x03\x04\x00\x00\xff\xfe", "model-not-xml", 1, "not XML"),
    ("solid cube\nfacet\n", "model-not-xml", 1, "not XML"),
    ("Panels:\n  - Class: x\n", "model-not-xml", 1, "not XML"),
    ("Panels:\n  - Frame: <Fixed Frame>\n", "model-not-xml", 1, "config of RViz"),
    ("#!/usr/bin/env python3\nprint()\n", "model-not-xml", 1, "not XML"),
    ('<robot name="로봇"/>'.encode("cp949"), "xml-encoding", 1, "UTF-8"),
    ('<?xml version="1.0" encoding="klingon"?><robot/>', "xml-encoding", 1, "klingon"),
    (ROBOT.format("<link name='\x01'/>\n"), "xml-control-character", 3, "U+0001"),
    ("hello\n<robot/>", "xml-not-well-formed", 1, "syntax error"),
    ("\n\n<?xml version='1.0'?>\n<robot/>", "xml-declaration-not-first", 3, "empty"),
    (" <?xml version='1.0'?>\n<robot/>", "xml-declaration-not-first", 1, "blank"),
    ("<?xml version=1.0?>\n<robot/>", "xml-not-well-formed", 1, "declaration"),
    (ROBOT.format("") + "<robot/>\n", "xml-two-robots", 4, "second"),
    (ROBOT.format("") + "end\n", "xml-not-well-formed", 4, "junk"),
    (ROBOT.format("") + "</robot>\n", "xml-closing-tag-surplus", 4, "nothing"),
    ("<robot/>\n<link/>\n</robot>", "xml-root-closed-early", 1, "slash"),
    (
        "<sdf>\n<model>\n</model>\n<link/>\n</model>\n</sdf>",
        "xml-closed-early",
        3,
        "early",
    ),
    ("<robot>\n<link/>\n", "xml-root-not-closed", 2, "never closed"),
    ("<robot>\n <link>\n  <visual>\n", "xml-root-not-closed", 3, "inside <visual>"),
    ("<robot>\n<link name='a'>\n<link name='b'/>", "xml-tag-not-closed", 2, "link"),
    (
        ROBOT.format("<link name='a'>\n<visual>\n</link>\n"),
        "xml-tag-not-closed",
        4,
        "visual",
    ),
    (ROBOT.format("<origin xyz='0'>\n"), "xml-tag-not-closed", 3, "origin"),
    (ROBOT.format("<a>\n<b>\n</a>\n</b>\n"), "xml-tag-not-closed", 5, "</b>"),
    (ROBOT.format("<link/>\n</link>\n"), "xml-closing-tag-surplus", 4, "slash"),
    (ROBOT.format("</visual>\n"), "xml-closing-tag-surplus", 3, "closes nothing"),
    (ROBOT.format("<visual></visaul>\n"), "xml-closing-tag-misspelt", 3, "visaul"),
    (ROBOT.format("<link></Link>\n"), "xml-tag-case", 3, "capital"),
    (ROBOT.format("<a b=1 c=2/>\n"), "xml-quotes-missing", 3, "quotes"),
    (ROBOT.format("<a b=”1”/>\n"), "xml-quotes-curly", 3, "curly"),
    (ROBOT.format('<a b="1/>\n<c d="2"/>\n'), "xml-quote-not-closed", 3, "b="),
    (ROBOT.format('<a b="1 c="2"/>\n'), "xml-quote-not-closed", 3, "b="),
    (ROBOT.format('<a b="${x == "1"}"/>\n'), "xml-not-well-formed", 3, "invalid token"),
    (ROBOT.format("<a b='1' b='2'/>\n"), "xml-attribute-twice", 3, "twice"),
    (ROBOT.format("<a b/>\n"), "xml-not-well-formed", 3, "invalid token"),
    (ROBOT.format("<a b='1'c='2'/>\n"), "xml-attributes-run-together", 3, "directly"),
    (ROBOT.format("<a b='1' / >\n"), "xml-not-well-formed", 3, "invalid token"),
    (ROBOT.format("< a/>\n"), "xml-not-well-formed", 3, "invalid token"),
    (ROBOT.format("<a><\\a>\n"), "xml-not-well-formed", 3, "invalid token"),
    (ROBOT.format("<a b='1'\n<c/>\n</a>"), "xml-tag-not-ended", 3, "missing"),
    (ROBOT.format("a & b\n"), "xml-ampersand", 3, "&"),
    (ROBOT.format("<a b='1 < 2'/>\n"), "xml-less-than", 3, "<"),
    (ROBOT.format("&nbsp;\n"), "xml-not-well-formed", 3, "undefined entity"),
    (ROBOT.format("<!-- a -- b -->\n"), "xml-comment-double-hyphen", 3, "--"),
    (ROBOT.format("<!-- a <!-- b --> -->\n"), "xml-comment-nested", 3, "inside"),
    (ROBOT.format("<!-- a\n"), "xml-comment-not-closed", 3, "swallows"),
    (ROBOT.format("<!- a ->\n"), "xml-not-well-formed", 3, "invalid token"),
    (ROBOT.format("]]>\n"), "xml-not-well-formed", 3, "not XML"),
    ("<link name='a'/>\n<link name='b'/>\n", "xml-not-well-formed", 2, "junk"),
    (
        '<!DOCTYPE robot [<!ENTITY a SYSTEM "a.xml">]>\n<robot/>',
        "xml-external-entity",
        1,
        "other files",
    ),
]


@pytest.mark.parametrize(("text", "code", "line", "word"), CASES)
def test_an_error_is_named_with_its_line(
    text: str | bytes, code: str, line: int, word: str
) -> None:
    problem = explained(text)[0]

    assert problem.code == code
    assert problem.severity == "error"
    assert problem.line == line
    assert word in problem.message
    assert problem.hint
    assert problem.file == "r.urdf"


def test_an_early_end_names_the_line_of_the_end_and_the_fix() -> None:
    problem = only('<robot name="r">\n</robot>\n<!-- c -->\n<link name="a"/>\n')

    assert problem.code == "xml-root-closed-early"
    assert problem.line == 2
    assert problem.message.startswith("line 2 closes </robot> too early")
    assert problem.hint == "move </robot> from line 2 to the last line of the file"


def test_an_early_end_with_a_second_end_is_to_be_deleted() -> None:
    problem = only("<robot>\n</robot>\n<link/>\n</robot>\n")

    assert problem.hint.startswith("delete </robot> on line 2")


def test_an_unclosed_tag_is_reported_with_the_places_to_open_and_to_close() -> None:
    problem = only(
        '<robot name="r">\n  <link name="a">\n    <visual/>\n  <joint name="j"/>\n'
        "</robot>\n"
    )

    assert problem.line == 3
    assert '<link name="a"> opened on line 2' in problem.message
    assert problem.hint == "add </link> after <visual …> on line 3"


def test_an_unclosed_tag_of_an_sdf_file_is_reported_where_it_is_opened() -> None:
    text = (
        '<sdf version="1.8">\n<model name="r">\n<joint name="j" type="fixed">\n'
        "<parent>a</parent>\n<child>b</child>\n</model>\n</sdf>\n"
    )
    problem = only(text)
    assert (problem.code, problem.line) == ("xml-tag-not-closed", 3)
    assert "joint" in problem.message


def test_a_misspelt_end_in_an_sdf_file_is_one_problem() -> None:
    text = '<sdf version="1.8"><model name="r"><pose>0 0 0 0 0 0</psoe></model></sdf>'
    assert "pose" in only(text).hint


def test_a_closing_tag_that_nothing_opens_names_what_may_be_missing() -> None:
    problem = only(
        '<robot name="r">\n  <material/>\n    <visual/>\n  </link>\n</robot>\n'
    )

    assert problem.code == "xml-closing-tag-surplus"
    assert problem.line == 4
    assert problem.hint == 'write <link name="…"> before <visual> on line 3'
    assert not problem.edits


def test_a_robot_that_was_never_opened_is_one_problem() -> None:
    problem = only('<link name="a"/>\n<link name="b"/>\n</robot>\n')

    assert (problem.code, problem.line) == ("xml-closing-tag-surplus", 1)
    assert "</robot> on line 3 closes nothing" in problem.message
    assert problem.hint.startswith('write <robot name="…"')
    assert not problem.edits


def test_a_misspelt_root_is_written_as_its_closing_tag() -> None:
    problem = only('<rbot name="a">\n<link name="b"/>\n</robot>\n')

    assert (problem.line, problem.hint) == (1, "write <robot>")


def test_a_closing_tag_with_the_name_of_a_macro_is_right() -> None:
    head = '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
    macro = '<xacro:macro name="arm" params="*b"/>\n'
    problem = only(f"{head}{macro}<xacro:am>\n<a/>\n</xacro:arm>\n</robot>\n")

    assert (problem.line, problem.hint) == (
        3,
        "write <xacro:arm>, as other elements are called",
    )


def test_an_sdf_that_was_never_opened_gets_its_opening_tag() -> None:
    text = '<model name="a">\n<link name="b"/>\n</model>\n</sdf>\n'
    problem = only(text)

    assert problem.hint == 'write <sdf version="1.8"> before <model name="a"> on line 1'


@pytest.mark.parametrize("value", ['imu"', '0 0 1"', "0 0 1'"])
def test_a_value_with_only_its_closing_quote_gets_the_other(value: str) -> None:
    problem = only(f'<robot name="r">\n<a type={value} b="c"/>\n</robot>\n')

    assert problem.code == "xml-quotes-missing"
    assert problem.hint == f'write type="{value[:-1]}"'


def test_what_is_read_before_an_unknown_error_is_still_explained() -> None:
    problem = only("<robot name=r>\n<a b/>\n</robot>")

    assert problem.code == "xml-quotes-missing"


def test_all_errors_are_reported_at_once() -> None:
    problems = explained("<robot name=r>\n<a b='1' b='2'/>\n<!-- - -- -->\n</robot>")

    assert [p.code for p in problems] == [
        "xml-quotes-missing",
        "xml-attribute-twice",
        "xml-comment-double-hyphen",
    ]


def test_windows_line_ends_do_not_shift_lines() -> None:
    assert only("<robot>\r\n\r\n<a b=1/>\r\n</robot>\r\n").line == 3


def test_good_xml_has_nothing_to_explain() -> None:
    assert explained(ROBOT.format("<link name='a'/>\n")) == []


def test_cut_and_shuffled_text_always_gets_an_explanation_with_a_line() -> None:
    chance = random.Random(7)
    good = ROBOT.format(
        '<link name="a">\n<!-- c -->\n<visual><origin xyz="0 0 1"/></visual>\n</link>\n'
    )
    for _ in range(400):
        text = list(good)
        for _ in range(chance.randint(1, 4)):
            at = chance.randrange(len(text))
            text[at : at + chance.randint(0, 3)] = chance.choice("<>/\"'=&! -x\0é“")
        joined = "".join(text)
        try:
            parse_xml(joined, "r.urdf")
        except XmlFault as fault:
            problems = explain_xml(joined, "r.urdf", fault)
            assert problems
            assert all(p.line and p.line <= joined.count("\n") + 1 for p in problems)


def test_a_long_broken_file_is_explained() -> None:
    text = "<robot>\n" + "<link name='a'><visual>\n" * 5000
    try:
        parse_xml(text, "r.urdf")
    except XmlFault as fault:
        assert len(explain_xml(text, "r.urdf", fault)) <= 12


@pytest.mark.parametrize(
    "junk",
    [
        "<",
        "&",
        '"',
        "<a>",
        "<a ",
        "<!--",
        "<a b='",
        "<\\",
        "</a>",
        "<a b=",
        "<!-",
        "< ",
        "é",
    ],
)
def test_a_long_file_of_junk_is_refused_without_much_work(junk: str) -> None:
    for text in (f"<robot name='r'>{junk * 20_000}", junk * 1_000_000):
        problems = explained(text)
        assert problems
        assert len(problems) <= 12


def test_many_attributes_of_one_element_are_read_in_one_pass() -> None:
    text = "".join(f" a{number}\n= '{number}'" for number in range(10_000))
    root = parse_xml(f"<robot{text}/>", "r.urdf")
    assert root.line_of("a9999") == 10_000
    assert only(f"<robot{text} a1=''/>").code == "xml-attribute-twice"


def test_entities_that_grow_beyond_the_limit_are_refused() -> None:
    entity = f"<!DOCTYPE robot [<!ENTITY a '{'x' * 400}'>]>"
    problem = only(f"{entity}<robot>{'&a;' * 200_000}</robot>")
    assert problem.code == "xml-external-entity"
    problem = only(f"{entity}<robot name='{'&a;' * 200_000}'/>")
    assert problem.code == "xml-external-entity"


def test_tags_that_are_nested_far_too_deeply_are_refused() -> None:
    text = "<robot>" + "<a>" * 1_000_000 + "</a>" * 1_000_000 + "</robot>"
    assert only(text).code == "xml-not-well-formed"


def test_a_document_with_too_many_elements_is_refused() -> None:
    text = ROBOT.format("<a/>" * 20)
    with pytest.raises(XmlFault) as caught:
        parse_xml(text, "r.urdf", most_elements=10)
    (problem,) = explain_xml(text, "r.urdf", caught.value)
    assert problem.code == "model-too-large"
