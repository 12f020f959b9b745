"""Edits do what the hint says: the problem is gone with them, and none is new."""

from __future__ import annotations

from pathlib import Path

import pytest
from edited import edited_files
from problem_samples import Sample, all_samples

from sambot_viz.checks import check
from sambot_viz.problems import group_problems

REVEALED = {
    "sdf-name-taken": {"root-not-unique"},
    "xacro-prefix-missing": {"root-not-unique"},
    "xacro-prefix-undeclared": {"xacro-left-over"},
    "cmake-command-missing": {"install-folder-missing"},
    "cmake-unclosed": {"cmake-command-missing"},
    "python-syntax": {"launch-code"},
}
"""What is seen only when the macro is called, or the file can be read."""


def with_edits() -> list[Sample]:
    return [
        sample
        for sample in all_samples()
        if sample.files and any(p.code == sample.code for p in sample.problems())
        if sample.problem.edits
    ]


def test_the_edits_of_a_sample_leave_nothing_of_its_problem(tmp_path: Path) -> None:
    samples = with_edits()
    assert len(samples) > 40
    for sample in samples:
        model = sample.write(tmp_path / sample.code)
        before = check(model, trusted=sample.trusted)
        own = [problem for problem in before if problem.code == sample.code]
        edits = [edit for problem in own for edit in problem.edits]
        for file, data in edited_files(edits).items():
            Path(file).write_bytes(data)
        after = {problem.code for problem in check(model, trusted=sample.trusted)}
        assert sample.code not in after, sample.code
        known = {problem.code for problem in before} | REVEALED.get(sample.code, set())
        if sample.code.startswith("xml-"):
            # What is not XML hides all else.
            known |= {code for code in after if not code.startswith("xml-")}
        assert after <= known, sample.code


def test_the_json_of_a_group_has_the_edits_of_all_its_problems(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    joints = "".join(
        f'<link name="l{n}"/>\n<joint name="j{n}" type="fixed">'
        f'<parent link="bse"/><child link="l{n}"/></joint>\n'
        for n in range(3)
    )
    model.write_text(f'<robot name="r">\n<link name="base"/>\n{joints}</robot>')
    (group,) = group_problems(check(model))
    assert group.as_json()["count"] == 3
    edits = group.as_json()["edits"]
    assert isinstance(edits, list)
    text = model.read_text()
    assert [text[edit["start"] : edit["end"]] for edit in edits] == ["bse"] * 3
    assert {edit["text"] for edit in edits} == {"base"}
    assert {edit["file"] for edit in edits} == {str(model)}


def test_what_a_macro_computes_has_no_edits(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
        '<xacro:property name="end" value="el"/>\n'
        '<link name="base"/><link name="wheel"/>\n'
        '<joint name="j" type="fixed"><parent link="base"/>'
        '<child link="wh${end}"/></joint></robot>'
    )
    (problem,) = check(model)
    assert problem.code == "joint-child-unknown"
    assert problem.edits == ()


@pytest.mark.parametrize(
    ("code", "old", "new"),
    [
        ("footprint-size", "", ""),
        ("sdf-joint-to-frame", "", ""),
        ("launch-world-name", 'name="room"', 'name="my room"'),
    ],
)
def test_a_doubtful_hint_has_no_edits(
    code: str, old: str, new: str, tmp_path: Path
) -> None:
    (sample,) = (each for each in all_samples() if each.code == code)
    model = sample.write(tmp_path / "package")
    for file in tmp_path.rglob("*.sdf"):
        file.write_text(file.read_text().replace(old, new))
    (problem,) = (each for each in check(model) if each.code == code)
    assert problem.hint.startswith("write ")
    assert problem.edits == ()


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_a_fixed_file_keeps_its_line_ends(tmp_path: Path, ends: str) -> None:
    model = tmp_path / "r.urdf"
    lines = ['<robot name="r">', '<link name="a">', "<visaul>", "<geometry>"]
    lines += ['<box size="1 1 1"/>', "</geometry>", "</visaul>", "</link>", "</robot>"]
    model.write_bytes(ends.join(lines).encode())
    (problem,) = check(model)
    ((file, data),) = edited_files(problem.edits).items()
    assert file == str(model)
    assert data == ends.join(lines).replace("visaul", "visual").encode()
