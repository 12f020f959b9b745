from pathlib import Path

import pytest

from sambot_viz import check
from sambot_viz.errors import Place
from sambot_viz.robot.xml.decode import XmlFault, decode, repaired_prolog
from sambot_viz.robot.xml.element import parse_xml


def test_every_element_has_its_line_and_column():
    root = parse_xml('<robot>\n  <link name="a">\n    <x/></link>\n</robot>', "f")

    link = root.find("link")
    assert link is not None
    assert link.place == Place("f", 2, 3)
    assert link.children[0].place == Place("f", 3, 5)
    assert link.children[0].parent is link


def test_a_prefix_is_part_of_the_name_and_needs_no_declaration():
    root = parse_xml('<robot><drake:thing xlink:href="u"/></robot>', "f")

    assert root.children[0].tag == "drake:thing"
    assert root.children[0].attributes == {"xlink:href": "u"}


def test_attributes_on_their_own_lines_are_found_there():
    root = parse_xml('<a\n  one="1"\n  two="2"/>', "f")

    assert root.line_of("two") == 3
    assert root.line_of(None) == 1


def test_a_tab_or_a_line_break_inside_a_value_is_noticed():
    root = parse_xml('<a one="1\t2" two="1 2" three="1\n2"/>', "f")

    assert root.odd_blanks == {"one", "three"}
    assert root.get("one") == "1 2"


def test_text_is_kept_without_comments():
    assert parse_xml("<a>one<!-- no --> two</a>", "f").text == "one two"


def test_an_xml_error_has_the_place_where_expat_stopped():
    with pytest.raises(XmlFault) as caught:
        parse_xml("<a>\n<b></a>", "f")

    assert caught.value.message == "mismatched tag"
    assert (caught.value.line, caught.value.column) == (2, 6)


@pytest.mark.parametrize(
    "doctype",
    [
        '<!DOCTYPE a SYSTEM "other.dtd">',
        '<!DOCTYPE a [<!ENTITY e SYSTEM "file:///etc/hostname">]>',
    ],
)
def test_nothing_outside_the_file_is_read(doctype: str):
    with pytest.raises(XmlFault, match="external entities"):
        parse_xml(f"{doctype}<a>&e;</a>", "f")


def test_an_entity_bomb_is_stopped():
    parts = ['<!ENTITY e0 "xxxxxxxxxxxxxxxxxxxx">']
    parts += [f'<!ENTITY e{n} "{f"&e{n - 1};" * 20}">' for n in range(1, 8)]
    with pytest.raises(XmlFault, match="amplification"):
        parse_xml(f"<!DOCTYPE a [{''.join(parts)}]><a>&e7;</a>", "f")


def test_text_is_decoded_by_mark_then_by_declaration_then_as_utf_8():
    assert decode("\ufeff<로봇/>".encode()) == "<로봇/>"
    korean = '<?xml version="1.0" encoding="euc-kr"?><로봇/>'
    assert decode(korean.encode("euc-kr")) == korean


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_utf_16_is_refused_as_in_ros(encoding: str, tmp_path: Path):
    model, text = tmp_path / "r.urdf", '<robot name="r">\n<link name="a"/></robot>\n'
    model.write_bytes(text.encode(encoding))

    (problem,) = check(model)

    assert problem.severity == "error" and problem.code == "xml-encoding"
    assert "saved as UTF-16" in problem.message
    assert problem.hint.startswith("save the file as UTF-8")
    model.write_bytes(text.encode())
    assert check(model) == []


def test_bytes_in_another_encoding_are_an_error_at_their_line():
    with pytest.raises(XmlFault, match="not utf-8") as caught:
        decode(b"<a>\n  <!-- \xb7 --></a>")

    assert (caught.value.line, caught.value.column) == (2, 8)


def test_a_declaration_without_a_version_is_replaced_and_lines_stay():
    assert repaired_prolog("<?xml?>\n<a/>") == '<?xml version="1.0"?>\n<a/>'
    good = '<?xml version="1.0" encoding="utf-8"?>\n<a/>'
    assert repaired_prolog(good) == good
    assert repaired_prolog("<a/>") == "<a/>"
