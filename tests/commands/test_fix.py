"""`sambot-viz check --fix` applies the edits of findings, and nothing else."""

from __future__ import annotations

import io
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random
from typing import Any

import pytest
from problem_samples import all_samples

from sambot_viz import fixes
from sambot_viz.checks import checked
from sambot_viz.cli import main
from sambot_viz.commands.fix import Fixing
from sambot_viz.errors import Edit, Problem

Capture = pytest.CaptureFixture[str]
WRONG = """\
<robot name="r">
<link name="base">
<visaul><geometry><box size="1 1 1"/></geometry></visaul></link>
<link name="arm"/><joint name="j" type="fixed">
<parent link="bse"/><child link="arm"/></joint>
</robot>
"""
RIGHT = WRONG.replace("visaul", "visual").replace("bse", "base")


class Terminal(io.StringIO):
    """A terminal, as far as programs ask."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = tmp_path / "r.urdf"
    path.write_text(WRONG)
    return path


@pytest.fixture
def answer(
    monkeypatch: pytest.MonkeyPatch,
) -> Iterator[Callable[..., tuple[int, str]]]:
    """Run `check --fix` on a terminal with answers: its status, and what it says."""

    def run(path: Path, *answers: str) -> tuple[int, str]:
        screen = Terminal()
        monkeypatch.setattr(sys, "stdout", screen)
        monkeypatch.setattr(sys, "stdin", Terminal("".join(f"{a}\n" for a in answers)))
        return main(["check", "--fix", str(path)]), screen.getvalue()

    yield run


def fix(path: Path, *flags: str) -> int:
    return main(["check", "--fix", "--yes", *flags, str(path)])


def test_all_edits_are_applied_without_asking(model: Path, capsys: Capture) -> None:
    assert fix(model) == 0
    assert model.read_text() == RIGHT
    out = capsys.readouterr().out
    assert f"--- {model}\n+++ {model}\n" in out
    assert (
        '-<parent link="bse"/><child link="arm"/></joint>\n+<parent link="base"' in out
    )
    assert out.endswith(f"2 findings fixed in {model}\n{model}: no problems found\n")


def test_a_second_run_changes_nothing(model: Path, capsys: Capture) -> None:
    fix(model)
    capsys.readouterr()
    saved = model.stat().st_mtime_ns
    assert fix(model) == 0
    assert model.stat().st_mtime_ns == saved
    assert capsys.readouterr().out == (
        f"no finding has an edit\n{model}: no problems found\n"
    )


def test_infos_are_fixed_only_when_that_is_asked_for(
    model: Path, capsys: Capture
) -> None:
    rate = "<updateRate>9</updateRate>"
    plugin = f'<plugin name="p" filename="libgazebo_ros_diff_drive.so">{rate}</plugin>'
    part = f"<gazebo>{plugin}</gazebo>\n</robot>"
    model.write_text(WRONG.replace("</robot>", part))
    left = RIGHT.replace("</robot>", part)
    assert fix(model) == 0
    assert model.read_text() == left
    said = capsys.readouterr().out.splitlines()
    at = said.index(f"2 findings fixed in {model}")
    assert said[at + 1] == "to fix 1 info too, add --infos"
    assert fix(model, "--infos") == 0
    assert model.read_text() == left.replace("updateRate", "update_rate")
    assert "--infos" not in capsys.readouterr().out


def test_each_finding_is_asked_for(
    model: Path, answer: Callable[..., tuple[int, str]]
) -> None:
    status, said = answer(model, "what?", "n", "y")
    assert status == 1
    assert model.read_text() == WRONG.replace("visaul", "visual")
    assert said.count("Apply? [y]es [n]o [a]ll [q]uit ") == 3
    plain = re.sub("\x1b\\[[0-9;]*m", "", said)
    assert said != plain
    assert f"1 finding fixed in {model}\n{model}:5:1: error[joint-parent" in plain


@pytest.mark.parametrize(
    ("answers", "after"),
    [
        (["a"], RIGHT),
        (["y", "q"], WRONG.replace("bse", "base")),
        (["Yes"], WRONG.replace("bse", "base")),
        (["quit"], WRONG),
        ([], WRONG),
    ],
    ids=["all", "quit", "end of input", "quit at once", "no input"],
)
def test_what_was_answered_before_the_end_is_applied(
    answers: list[str],
    after: str,
    model: Path,
    answer: Callable[..., tuple[int, str]],
) -> None:
    status, _ = answer(model, *answers)
    assert model.read_text() == after
    assert status == ("bse" in after)


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--fix"], "--fix asks on a terminal, and there is none; add --yes"),
        (["--yes"], "--yes answers the questions of --fix; give both"),
        (["--infos"], "--infos says what --fix --yes applies; give all three"),
        (["--fix", "--infos"], "--infos says what --fix --yes applies; give all three"),
        (["--fix", "--yes", "--format=json"], "does not go with --format json"),
        (["--fix", "--yes", "--format=sarif"], "does not go with --format sarif"),
        (["--fix", "--yes", "--untrusted"], "does not go with --untrusted"),
    ],
)
def test_what_cannot_be_is_one_sentence(
    words: list[str], reason: str, model: Path, capsys: Capture
) -> None:
    assert main(["check", str(model), *words]) == 2
    said = capsys.readouterr().err
    assert reason in said and said.count("\n") == 1
    assert model.read_text() == WRONG


def test_the_bundled_robot_is_not_changed(capsys: Capture) -> None:
    assert main(["check", "--fix", "--yes"]) == 2
    assert "--fix needs a MODEL" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("head", "encoding", "ends"),
    [
        ("", "utf-8", "\r\n"),
        ("", "utf-8-sig", "\n"),
        ('<?xml version="1.0" encoding="latin-1"?><!-- ä -->\n', "latin-1", "\r\n"),
        ("<!-- ä -->\n", "utf-8", "\n"),
    ],
    ids=["line ends", "byte order mark", "latin-1", "utf-8"],
)
def test_the_file_keeps_all_else(
    head: str, encoding: str, ends: str, model: Path
) -> None:
    def written(text: str) -> bytes:
        return f"{head}{text}".replace("\n", ends).encode(encoding)

    model.write_bytes(written(WRONG))
    model.chmod(0o640)
    fix(model)
    assert model.read_bytes() == written(RIGHT)
    assert model.stat().st_mode & 0o777 == 0o640
    assert list(model.parent.iterdir()) == [model]


def test_a_file_in_utf_16_is_left_alone(model: Path) -> None:
    data = WRONG.encode("utf-16")
    model.write_bytes(data)
    assert fix(model) == 1
    assert model.read_bytes() == data


def test_files_elsewhere_are_left_alone(tmp_path: Path, capsys: Capture) -> None:
    package, other = tmp_path / "package", tmp_path / "other"
    for folder in (package, other):
        folder.mkdir()
    (package / "package.xml").write_text("<package><name>r</name></package>")
    (other / "r.urdf").write_text(WRONG)
    (package / "r.urdf").symlink_to(other / "r.urdf")
    assert fix(package / "r.urdf") == 1
    assert (other / "r.urdf").read_text() == WRONG
    out = capsys.readouterr().out
    assert f"not applied: {package / 'r.urdf'} is outside of the package" in out


def test_a_read_only_file_is_left_alone(model: Path, capsys: Capture) -> None:
    model.chmod(0o444)
    assert fix(model) == 1
    assert model.read_text() == WRONG
    assert f"not applied: {model} is read-only" in capsys.readouterr().out


def test_a_link_within_the_package_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text("<package><name>r</name></package>")
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf" / "r.urdf").write_text(WRONG)
    link = tmp_path / "r.urdf"
    link.symlink_to(tmp_path / "urdf" / "r.urdf")
    assert fix(link) == 0
    assert link.is_symlink()
    assert (tmp_path / "urdf" / "r.urdf").read_text() == RIGHT


def test_a_file_that_changed_meanwhile_is_left_alone(
    model: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    other = WRONG.replace("arm", "leg")
    check = checked.check_all

    def check_and_save(path: Path, **options: Any) -> checked.Checked:
        found = check(path, **options)
        if model.read_text() == WRONG:
            model.write_text(other)
        return found

    monkeypatch.setattr(checked, "check_all", check_and_save)
    assert fix(model) == 1
    assert model.read_text() == other
    out = capsys.readouterr().out
    assert f"not applied: {model} has changed since it was checked" in out


class Rules:
    """Rules about the words of a file: which are wrong, and what to write.

    Args:
        file: the file.
        rules: word → what is to be written in its place; empty where it is not known.
    """

    def __init__(self, file: Path, rules: dict[str, str]) -> None:
        self._file = file
        self._rules = rules

    def __call__(self) -> list[Problem]:
        text, found = self._file.read_text(), list[Problem]()
        for word, right in self._rules.items():
            if (at := text.find(word)) >= 0:
                edit = Edit(str(self._file), at, at + len(word), right, hash(text))
                found.append(
                    Problem(
                        "error",
                        word,
                        f"{word} is wrong",
                        file=str(self._file),
                        line=text.count("\n", 0, at) + 1,
                        column=at - text.rfind("\n", 0, at),
                        edits=(edit,) if right else (),
                    )
                )
        return found


def fixed(tmp_path: Path, text: str, rules: dict[str, str]) -> str:
    file = tmp_path / "words"
    file.write_text(text)
    Fixing(Rules(file, rules), [tmp_path], asks=False).run()
    return file.read_text()


def test_edits_that_overlap_are_applied_one_round_after_the_other(
    tmp_path: Path,
) -> None:
    assert fixed(tmp_path, "a b c", {"a b": "A b", "b c": "B c"}) == "A B c"


def test_an_edit_that_reveals_another_finding_is_followed(tmp_path: Path) -> None:
    assert fixed(tmp_path, "a", {"a": "b", "b": "c", "c": "d"}) == "d"


@pytest.mark.parametrize("rules", [["ab", "ba"], ["ab", "bc", "ca"]])
def test_edits_that_undo_each_other_end_and_fix_nothing(
    rules: list[str], tmp_path: Path, capsys: Capture
) -> None:
    assert fixed(tmp_path, "a", {r[0]: r[1] for r in rules}) == "a"
    out = capsys.readouterr().out
    assert f"{tmp_path / 'words'}: as it was before: edits undo each other" in out
    assert "fixed in" not in out


def test_an_edit_after_which_the_finding_stays_is_undone(
    tmp_path: Path, capsys: Capture
) -> None:
    assert fixed(tmp_path, "a", {"a": "aa"}) == "a"
    out = capsys.readouterr().out
    assert "words:1:1: not applied: the finding stays" in out
    assert "fixed in" not in out


@pytest.mark.parametrize("seed", range(20))
def test_no_rules_make_more_findings_or_claim_fixes_that_are_none(
    seed: int, tmp_path: Path, capsys: Capture
) -> None:
    random = Random(seed)
    words = "abcd"
    rules = {word: random.choice(["", *words, "a b", "c d"]) for word in words}
    text = " ".join(random.choices(words, k=4))
    before = Counter(text.split())
    after = Counter(fixed(tmp_path, text, rules).split())
    out = capsys.readouterr().out
    assert len(after) <= len(before)
    assert ("fixed in" not in out) or before != after


def test_an_edit_that_makes_more_errors_is_undone_and_the_others_stay(
    tmp_path: Path, capsys: Capture
) -> None:
    rules = {"one": "1", "two": "x y", "three": "3", "x": "", "y": ""}
    assert fixed(tmp_path, "one\ntwo\nthree", rules) == "1\ntwo\n3"
    out = capsys.readouterr().out
    assert "words:2:1: not applied: it leads to another error: " in out
    assert f"2 findings fixed in {tmp_path / 'words'}" in out


PACKAGE = """<package format="3"><name>bot</name><version>1.0.0</version>
<description>a bot</description><maintainer email="a@example.org">a</maintainer>
<license>Apache-2.0</license><buildtool_depend>ament_cmake</buildtool_depend>
<export><build_type>ament_cmake</build_type></export></package>
"""
BUILD = """cmake_minimum_required(VERSION 3.8)
project(bot)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
ament_package()
"""
LAUNCH = """import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.substitutions import Command
from launch_ros.actions import Node

def generate_launch_description():
    model = os.path.join(get_package_share_directory("bot"), "urdf", "r.urdf.xarco")
    text = {"robot_description": Command(["xacro ", model])}
    return LaunchDescription([Node(package="robot_state_publisher",
        executable="robot_state_publisher", parameters=[text])])
"""


def test_an_error_of_another_file_that_an_edit_shows_is_mended_next(
    tmp_path: Path,
) -> None:
    texts = {
        "package.xml": PACKAGE,
        "CMakeLists.txt": BUILD,
        "launch/r.launch.py": LAUNCH,
        "urdf/r.urdf.xacro": RIGHT,
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    main(["check", "--fix", "--yes", str(tmp_path)])
    assert '"r.urdf.xacro")' in (tmp_path / "launch/r.launch.py").read_text()
    assert "install(DIRECTORY urdf" in (tmp_path / "CMakeLists.txt").read_text()


def test_of_several_files_all_are_written_or_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = tmp_path / "one", tmp_path / "other"
    for file in (one, other):
        file.write_text("a")
    edits = [Edit(str(file), 0, 1, "b", hash("a")) for file in (one, other)]
    made = fixes.changes(edits, [tmp_path])
    write = fixes.write_atomically

    def fail_for_the_other(path: Path, data: bytes) -> None:
        if path == other:
            raise OSError("the disk is full")
        write(path, data)

    monkeypatch.setattr(fixes, "write_atomically", fail_for_the_other)
    with pytest.raises(fixes.EditRefused, match="cannot be written: the disk is full"):
        fixes.write_changes(made)
    assert one.read_text() == other.read_text() == "a"


def test_a_letter_that_the_encoding_lacks_is_not_written(tmp_path: Path) -> None:
    file = tmp_path / "r.xml"
    file.write_text(text := '<?xml version="1.0" encoding="latin-1"?>a')
    edits = [Edit(str(file), len(text) - 1, len(text), "바", hash(text))]
    with pytest.raises(fixes.EditRefused, match="is in latin-1, which has no 바"):
        fixes.changes(edits, [tmp_path])
    with pytest.raises(fixes.EditRefused, match="cannot be read"):
        fixes.changes([Edit(str(tmp_path / "none"), 0, 0, "a")], [tmp_path])


def test_each_sample_is_fixed_as_far_as_it_has_edits(
    tmp_path: Path, capsys: Capture
) -> None:
    samples = [
        sample
        for sample in all_samples()
        if sample.trusted and any(problem.edits for problem in sample.problems())
    ]
    assert len(samples) > 40
    for sample in samples:
        folder = tmp_path / sample.code
        model = sample.write(folder)
        files = [path for path in folder.rglob("*") if path.is_file()]
        for path in files:
            path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
        before = [path.read_bytes() for path in files]
        fix(model, "--infos")
        after = [path.read_bytes() for path in files]
        assert before != after, sample.code
        assert all(data.count(b"\n") == data.count(b"\r\n") for data in after)
        capsys.readouterr()
        fix(model, "--infos")
        assert [path.read_bytes() for path in files] == after, sample.code
        said = capsys.readouterr().out
        assert "no finding has an edit" in said, sample.code
