"""Edits are made only where the file has the wrong word itself, and keep the rest."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from lower_limit import lower

from sambot_viz.edits import (
    apply_edits,
    rename_attribute,
    rename_element,
    together,
    write,
    write_attribute,
    write_between,
)
from sambot_viz.errors import Edit, Fix, Place
from sambot_viz.fixes import EditRefused


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "file"


def at(file: Path, line: int, column: int | None = None) -> Place:
    return Place(str(file), line, column)


def after(file: Path, fix: Fix) -> str:
    """The content of a file after a fix; it has to have edits."""
    assert fix.edits
    return edited_files(fix.edits)[str(file)].decode()


def test_edits_are_made_in_any_order_and_each_once() -> None:
    edits = [Edit("f", 4, 5, "E"), Edit("f", 0, 1, "A"), Edit("f", 4, 5, "E")]
    assert apply_edits([*edits, Edit("f", 5, 5, "!")], "abcde") == "AbcdE!"
    assert apply_edits([], "abc\r\n") == "abc\r\n"


def test_two_edits_of_the_same_text_are_refused() -> None:
    with pytest.raises(ValueError, match="the same text"):
        apply_edits([Edit("f", 0, 2, "x"), Edit("f", 1, 3, "y")], "abc")


@pytest.mark.parametrize(
    "data",
    [
        b"# \xc3\xa4\r\nframe: odm\r\n",
        b"\xef\xbb\xbf# \xc3\xa4\nframe: odm",
        b'<?xml version="1.0" encoding="latin-1"?><!-- \xe4 -->\n<a>odm</a>\n',
    ],
    ids=["line ends", "byte order mark", "declared encoding"],
)
def test_line_ends_and_encoding_stay_as_they_are(file: Path, data: bytes) -> None:
    file.write_bytes(data)
    fix = write(at(file, 2), "odm", "odom")
    assert fix.hint == "write odom"
    assert edited_files(fix.edits) == {str(file): data.replace(b"odm", b"odom")}


@pytest.mark.parametrize(
    ("line", "wrong", "right"),
    [
        ("frame: odm", "odm", "frame: odom"),
        ("odm: odm  # the frame", "odm", "odm: odom  # the frame"),
        ("odm: 3", "odm", "odom: 3"),
        ('f(name="odm", x=odm_link)', "odm", 'f(name="odom", x=odm_link)'),
    ],
)
def test_a_word_is_found_as_a_whole(
    file: Path, line: str, wrong: str, right: str
) -> None:
    file.write_text(f"# odm\n{line}\n")
    assert after(file, write(at(file, 2), wrong, "odom")) == f"# odm\n{right}\n"


@pytest.mark.parametrize(
    "line",
    [
        "[odm, odm]",
        "frame: demo/odm",
        "frame: odm_link",
        "frame: odm.x",
        "frame: other",
    ],
)
def test_a_word_that_is_not_certain_has_no_edit(file: Path, line: str) -> None:
    file.write_text(line)
    assert write(at(file, 1), "odm", "odom", ", the frame") == Fix(
        "write odom, the frame"
    )


def test_a_word_is_looked_for_behind_its_column(file: Path) -> None:
    file.write_text("Node('a'), Node('a')")
    fix = write(at(file, 1, 12), "a", "b", hint="write Node('b')")
    assert fix.hint == "write Node('b')"
    assert after(file, fix) == "Node('a'), Node('b')"


def test_in_xml_a_word_is_a_value_and_no_name(file: Path) -> None:
    file.write_text("<topic>\n  topic\n</topic>")
    assert after(file, write(at(file, 1, 1), "topic", "scan")) == (
        "<topic>\n  scan\n</topic>"
    )


def test_a_value_that_xacro_computes_has_no_edit(file: Path) -> None:
    file.write_text('<link name="${prefix}_link"/>')
    assert write_attribute(at(file, 1, 1), "name", "a_link", "b_link").edits == ()


def test_an_attribute_is_known_by_its_numbers(file: Path) -> None:
    file.write_text("<limit lower = '-90.0'\n upper=\"90\"/>")
    place = at(file, 1, 1)
    lower = write_attribute(place, "lower", [-90.0], "-1.57")
    upper = write_attribute(place, "upper", [90.0], "1.57")
    assert lower.hint == 'write lower="-1.57"'
    both = together("write both", lower, upper)
    assert after(file, both) == "<limit lower = '-1.57'\n upper=\"1.57\"/>"
    other = write_attribute(place, "upper", [80.0], "1.4")
    assert together("write both", lower, other) == Fix("write both")


def test_a_value_that_would_be_markup_has_no_edit(file: Path) -> None:
    file.write_text('<link name="a"/>')
    assert write_attribute(at(file, 1, 1), "name", "a", "<b>").edits == ()


def test_an_element_is_renamed_in_its_end_tag_too(file: Path) -> None:
    file.write_text(
        '<visaul a="/>">\n<!-- </visaul> -->\n<visaul/><visaul ></visaul>\n</visaul >\n'
    )
    fix = rename_element(at(file, 1, 1), "visaul", "visual", "write <visual>")
    assert after(file, fix) == (
        '<visual a="/>">\n<!-- </visaul> -->\n<visaul/><visaul ></visaul>\n</visual >\n'
    )
    inner = rename_element(at(file, 3, 1), "visaul", "visual", "write <visual>")
    assert len(inner.edits) == 1
    assert rename_element(at(file, 1, 1), "other", "visual", "").edits == ()
    assert rename_element(at(file, 2, 1), "visaul", "visual", "").edits == ()


def test_an_element_without_an_end_tag_is_not_renamed(file: Path) -> None:
    file.write_text("<visaul>")
    assert rename_element(at(file, 1, 1), "visaul", "visual", "").edits == ()


def test_an_attribute_is_renamed_and_its_value_completed(file: Path) -> None:
    file.write_text('<color\n  rbga="1 0 0"/>')
    fix = rename_attribute(at(file, 1, 1), "rbga", "rgba", "1 0 0 1", "write it")
    assert after(file, fix) == '<color\n  rgba="1 0 0 1"/>'


def test_an_attribute_does_not_get_the_name_of_another(file: Path) -> None:
    file.write_text('<color rbga="1" rgba="2"/>')
    assert rename_attribute(at(file, 1, 1), "rbga", "rgba", "1", "").edits == ()


def test_all_between_two_places_is_replaced(file: Path) -> None:
    file.write_text('rate: "30"\n')
    fix = write_between(at(file, 1, 7), at(file, 1, 11), "30.0", "write 30.0")
    assert after(file, fix) == "rate: 30.0\n"


def test_what_cannot_be_read_has_no_edits(tmp_path: Path) -> None:
    (tmp_path / "bytes").write_bytes(b"\xff")
    (tmp_path / "odd").write_bytes(b'<?xml version="1.0" encoding="no-such"?>')
    for name in ("none", "bytes", "odd", "."):
        place = Place(str(tmp_path / name), 1, 1)
        assert write(place, "a", "b") == Fix("write b")
        assert write_between(place, place, "a", "write a") == Fix("write a")
        assert rename_element(place, "a", "b", "write <b>") == Fix("write <b>")
        with pytest.raises(EditRefused):
            edited_files([Edit(place.file, 0, 0, "a")])
    file = tmp_path / "short"
    file.write_text("a")
    assert write(Place(str(file), 7, 3), "a", "b").edits == ()


def test_a_file_that_is_too_large_has_no_edits(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = b"frame: odm"
    file.write_bytes(data)
    lower(monkeypatch, "FIXED_FILE", len(data))
    assert after(file, write(at(file, 1), "odm", "odom")) == "frame: odom"
    lower(monkeypatch, "FIXED_FILE", len(data) - 1)
    assert write(at(file, 1), "odm", "odom") == Fix("write odom")
