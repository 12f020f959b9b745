"""The text of the model in the page: typed, shown, checked, fixed and saved."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from inside import session_of, viser_server
from lower_limit import lower
from protocol_client import ProtocolClient
from written import write_wanted

from sambot_viz import Visualizer, bundled
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options

Protocol = Callable[..., ProtocolClient]
HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
GOOD = f"""{HEAD}
<link name="hull"/>
<link name="arm"/><!-- ä 🤖 -->
<xacro:include filename="leg.xacro"/>
<joint name="j" type="fixed"><parent link="hull"/><child link="arm"/></joint>
</robot>
"""
LEG = f"""{HEAD}
<link name="leg"/>
<joint name="k" type="fixed"><parent link="hull"/><child link="leg"/></joint>
</robot>
"""
MODEL = "urdf/r.urdf.xacro"


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "package"
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>package</name></package>")
    (folder / MODEL).write_bytes(GOOD.replace("\n", "\r\n").encode("utf-8-sig"))
    (folder / "urdf" / "leg.xacro").write_text(LEG)
    return folder


class Editor:
    """A page whose panel Model is open."""

    def __init__(self, viz: Visualizer, client: ProtocolClient) -> None:
        self.viz, self.client = viz, client
        client.act("model/show", True)
        client.wait_until(lambda: self.value("text") is not None)

    def value(self, name: str) -> Any:
        return self.client.rows.get(f"model/{name}", {}).get("value")

    @property
    def text(self) -> str:
        return self.value("text")["text"]

    @property
    def links(self) -> set[str]:
        robot = session_of(self.viz).robot.model
        return set() if robot is None else set(robot.links)

    @property
    def notice(self) -> str:
        return self.client.rows.get("notice", {}).get("value", {}).get("text", "")

    def open(self, name: str) -> None:
        self.client.act("model/open", name)
        self.client.wait_until(lambda: self.value("text")["file"] == name)

    def replace(self, old: str, new: str) -> None:
        """Write a word for another, as the page sends it: in UTF-16 units."""
        shown = self.value("text")
        before, found, _ = shown["text"].partition(old)
        assert found
        start, length = (len(part.encode("utf-16-le")) // 2 for part in (before, old))
        place = start, start + length
        file, version = shown["file"], shown["version"]
        self.client.act("model/type", file, version, *place, new, False)
        self.client.wait_until(lambda: self.value("text")["version"] == version + 1)

    def take(self, command: str, *values: object) -> None:
        """Ask for a text, and write it as the page does."""
        write_wanted(self.client, f"model/{command}", *values)

    def problems(self) -> list[dict[str, Any]]:
        """What is wrong with the text, once it is checked."""

        def is_checked() -> bool:
            found, version = self.value("found"), self.value("text")["version"]
            return found is not None and found["version"] == version

        self.client.wait_until(is_checked)
        return self.value("found")["problems"]


@pytest.fixture
def show(package: Path, protocol: Protocol) -> Iterator[Callable[..., Visualizer]]:
    with ExitStack() as stack:

        def start(path: Path = package / MODEL, **options: Any) -> Visualizer:
            inputs = Inputs(Options(path, watch=True, **options), may_be_broken=True)
            return stack.enter_context(Visualizer.of_inputs(inputs))

        yield start


@pytest.fixture
def edit(show: Callable[..., Visualizer], protocol: Protocol) -> Callable[..., Editor]:
    def open_editor(viz: Visualizer | None = None, path: str = "/", **o: Any) -> Editor:
        shown = show(**o) if viz is None else viz
        client = protocol(shown.viser.get_port(), path=path)
        client.settle(viser_server(shown))
        return Editor(shown, client)

    return open_editor


def test_the_text_comes_when_the_panel_is_open_and_the_robot_follows_it(
    edit: Callable[..., Editor], package: Path
) -> None:
    editor = edit()
    assert editor.text == GOOD
    names = [file["name"] for file in editor.value("files")]
    assert names[:2] == [MODEL, "urdf/leg.xacro"] and "package.xml" in names
    editor.replace('name="arm"/>', 'name="armm"/>')
    # A joint names a link that is not there: the last robot stays.
    (wrong,) = (p for p in editor.problems() if p["severity"] == "error")
    assert editor.links == {"hull", "arm", "leg"}
    ((start, end, new),) = wrong["edits"]
    units = editor.text.encode("utf-16-le")
    assert units[2 * start : 2 * end].decode("utf-16-le") == "arm" and new == "armm"
    editor.replace('child link="arm"', 'child link="armm"')
    editor.client.wait_until(lambda: editor.links == {"hull", "armm", "leg"})
    # Another file of the model.
    editor.open("urdf/leg.xacro")
    assert editor.text == LEG
    editor.replace('"leg"', '"foot"')
    editor.replace('child link="leg"', 'child link="foot"')
    editor.client.wait_until(lambda: editor.links == {"hull", "armm", "foot"})
    assert not [p for p in editor.problems() if p["severity"] == "error"]
    # Nothing is written.
    assert (package / "urdf/leg.xacro").read_text() == LEG
    editor.take("revert", "urdf/leg.xacro")
    editor.client.wait_until(lambda: editor.links == {"hull", "armm", "leg"})
    editor.take("revert", MODEL)
    editor.client.wait_until(lambda: editor.links == {"hull", "arm", "leg"})
    assert not session_of(editor.viz).own_model
    assert "model/save" not in editor.client.rows


def test_a_fix_mends_the_text_by_the_panel_problems_too(
    edit: Callable[..., Editor],
) -> None:
    editor = edit()
    editor.replace('parent link="hull"', 'parent link="hul"')
    (problem,) = (p for p in editor.problems() if p["severity"] == "error")
    editor.client.act("model/fix", problem["id"])
    editor.client.wait_until(lambda: editor.text == GOOD)

    def acts() -> list[tuple[Any, ...]]:
        return [row["act"] for row in editor.client.rows.values() if "act" in row]

    # The saved text is back; or it is not, after another change.
    for text in (GOOD, GOOD.replace('name="arm"/>', 'name="arm" />')):
        if text != GOOD:
            editor.replace('name="arm"/>', 'name="arm" />')
        editor.replace('parent link="hull"', 'parent link="hul"')
        assert editor.problems()
        editor.client.wait_until(lambda: bool(acts()))
        ((_, command, row),) = acts()
        editor.client.act(command, row)
        editor.client.wait_until(lambda text=text: editor.text == text)
        assert editor.notice.startswith("Applied: ")
        assert ("not saved" in editor.notice) == (text != GOOD)


@pytest.mark.parametrize(
    ("wrong", "line", "mended"),
    [
        # What keeps the model from being read has its fix, as `check --fix` has it.
        ('<robot>\n<link name="hull"/>\n</robot>\n', 1, '<robot name="my_robot">'),
        # A fix that changes lines before, too, is marked at the mistake.
        (
            '<robot name="r">\n<link name="hull"/>\n<visual><geometry>'
            '<sphere radius="0.1"/></geometry></visual>\n</robot>\n',
            3,
            "</visual></link>",
        ),
    ],
)
def test_a_mistake_is_marked_at_its_line_and_its_fix_is_offered(
    edit: Callable[..., Editor],
    show: Callable[..., Visualizer],
    package: Path,
    wrong: str,
    line: int,
    mended: str,
) -> None:
    file = package / "urdf" / "plain.urdf"
    file.write_text('<robot name="r">\n<link name="hull"/>\n</robot>\n')
    editor = edit(show(file, edit=True))
    editor.replace(editor.text, wrong)
    (problem,) = editor.problems()
    assert problem["fix"] and 1 + wrong.count("\n", 0, problem["from"]) == line
    for start, end, new in reversed(problem["edits"]):
        wrong = wrong[:start] + new + wrong[end:]
    assert mended in wrong
    editor.replace(editor.text, wrong)
    assert editor.problems() == []
    assert "hull" in editor.links


@pytest.mark.parametrize("by_page", [False, True])
def test_what_was_applied_is_not_listed_beside_the_error_that_it_uncovers(
    edit: Callable[..., Editor],
    show: Callable[..., Visualizer],
    package: Path,
    by_page: bool,
) -> None:
    file = package / "urdf" / "plain.urdf"
    wrong = '<xacro:proprty name="a" value="1"/>'
    file.write_text(f'<robot name="r">\n{wrong}\n<link name="hull"/>\n</robot>\n')
    editor = edit(show(file))
    (problem,) = editor.problems()
    assert problem["severity"] == "warning"
    if by_page:
        ((start, end, new),) = problem["edits"]
        shown = editor.value("text")
        place = shown["file"], shown["version"], start, end
        editor.client.act("model/type", *place, new, False)
    else:
        editor.client.act("model/fix", problem["id"])
    editor.client.wait_until(lambda: HEAD in editor.text)
    assert [found["severity"] for found in editor.problems()] == ["error"]


def test_the_name_of_the_package_is_that_of_the_text(
    edit: Callable[..., Editor], package: Path
) -> None:
    (package / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(package)\n"
        "find_package(ament_cmake REQUIRED)\nament_package()\n"
    )
    editor = edit()

    def codes() -> set[str]:
        listed = session_of(editor.viz).problems.shown.value.listed
        return {problem.code for problem in listed}

    editor.open("package.xml")
    editor.replace("<name>package<", "<name>parcel<")
    editor.client.wait_until(lambda: "cmake-project-name" in codes())
    editor.replace("<name>parcel<", "<name>package<")
    editor.client.wait_until(lambda: "cmake-project-name" not in codes())


def test_saving_keeps_the_encoding_and_the_line_ends(
    edit: Callable[..., Editor], package: Path
) -> None:
    editor = edit(edit=True)
    editor.replace('name="arm"/>', 'name="arm"/>\n<link name="new"/>')
    editor.replace(
        "</robot>",
        '<joint name="n" type="fixed"><parent link="arm"/><child link="new"/></joint>\n'
        "</robot>",
    )
    editor.client.wait_until(lambda: "new" in editor.links)
    editor.client.act("model/save", MODEL)
    editor.client.wait_until(lambda: editor.notice == f"Saved {MODEL}")
    written = (package / MODEL).read_bytes()
    assert written == editor.text.replace("\n", "\r\n").encode("utf-8-sig")
    editor.client.wait_until(lambda: not editor.value("text")["changed"])
    editor.client.wait_until(lambda: not session_of(editor.viz).own_model)
    assert "new" in editor.links


def test_what_another_program_saved_is_never_overwritten_unasked(
    edit: Callable[..., Editor], package: Path
) -> None:
    editor, file = edit(edit=True), package / "urdf" / "leg.xacro"
    editor.open("urdf/leg.xacro")
    # Without changes here, it is taken as it is.
    theirs = LEG.replace("</robot>", "<!-- theirs -->\n</robot>")
    file.write_text(theirs)
    editor.client.wait_until(lambda: editor.text == theirs)
    editor.replace('"k"', '"kk"')
    mine, others = editor.text, theirs.replace('"k"', '"paw"')
    file.write_text(others)
    editor.client.act("model/save", "urdf/leg.xacro")
    editor.client.wait_until(lambda: "another program" in editor.notice)
    assert (file.read_text(), editor.text) == (others, mine)
    (conflict,) = editor.value("text")["conflicts"]
    assert conflict["line"] == 3 and 'name="paw"' in conflict["theirs"]
    editor.client.act("model/resolve", "urdf/leg.xacro", False)
    editor.client.act("model/save", "urdf/leg.xacro")
    editor.client.wait_until(lambda: file.read_text() == mine)
    # A file that is gone is written again only when that is asked for.
    editor.replace('"kk"', '"kkk"')
    file.unlink()
    editor.client.wait_until(lambda: editor.value("text")["gone"])
    assert editor.text == mine.replace('"kk"', '"kkk"')
    editor.client.act("model/resolve", "urdf/leg.xacro", False)
    editor.client.act("model/save", "urdf/leg.xacro")
    editor.client.wait_until(file.exists)
    assert file.read_text() == editor.text


def test_a_model_that_is_gone_is_a_problem_though_the_editor_has_its_text(
    edit: Callable[..., Editor], package: Path
) -> None:
    editor = edit()
    (package / MODEL).unlink()
    problems = session_of(editor.viz).problems
    editor.client.wait_until(lambda: "is gone" in problems.shown.value.note)
    codes = [problem.code for problem in problems.shown.value.listed]
    assert codes.count("model-not-found") == 1


def test_changes_of_other_lines_are_merged_and_conflicts_ask_one_by_one(
    edit: Callable[..., Editor], package: Path
) -> None:
    editor, name = edit(edit=True), "urdf/leg.xacro"
    file, more = package / name, "".join(f"<!-- {n} -->\n" for n in range(6))
    editor.open(name)
    base = LEG.replace("</robot>", f"{more}</robot>")
    file.write_text(base)
    editor.client.wait_until(lambda: editor.text == base)
    for number in (0, 2, 4):
        editor.replace(f"<!-- {number} -->", f"<!-- mine {number} 🤖 -->")
    file.write_text(base.replace("<!-- 1", "<!-- theirs"))
    editor.client.wait_until(lambda: "theirs" in editor.text)
    shown = editor.value("text")
    assert shown["merges"] == 1 and not shown["asks"]
    mine = [line for line in editor.text.splitlines() if line.startswith("<!--")]
    assert mine[:3] == ["<!-- mine 0 🤖 -->", "<!-- theirs -->", "<!-- mine 2 🤖 -->"]
    # Two of the lines that were changed here are changed there too, and one more.
    others = file.read_text()
    for number in (2, 4, 5):
        others = others.replace(f"<!-- {number}", f"<!-- their {number}")
    file.write_text(others)
    editor.client.wait_until(lambda: editor.value("text")["conflicts"])
    shown = editor.value("text")
    assert "mine 4 🤖 -->\n<!-- their 5" in shown["text"]
    first, second = shown["conflicts"]
    assert (first["theirs"], second["theirs"]) == (
        "<!-- their 2 -->\n",
        "<!-- their 4 -->\n",
    )
    version = shown["version"]
    editor.client.act("model/choose", name, version, second["from"], False)
    editor.client.wait_until(lambda: editor.value("text")["conflicts"] == [first])
    assert editor.text == shown["text"]
    editor.take("choose", name, version, first["from"], True)
    editor.client.wait_until(lambda: not editor.value("text")["asks"])
    for old, new in (("0", "mine 0 🤖"), ("their 4", "mine 4 🤖")):
        others = others.replace(f"<!-- {old} -->", f"<!-- {new} -->")
    assert editor.text == others
    editor.client.act("model/save", name)
    editor.client.wait_until(lambda: file.read_text() == editor.text)


def test_who_has_control_adds_a_file_in_the_package_and_over_none(
    edit: Callable[..., Editor], package: Path
) -> None:
    options = {"presenter": "teach-the-class", "edit": True}
    editor = edit(**options, path="/?token=teach-the-class")
    viewer = edit(editor.viz)
    viewer.client.act("model/create", "a.urdf")
    viewer.client.wait_until(lambda: viewer.notice.startswith("View only"))
    (package / "out").symlink_to(package.parent)
    (package / "gone.xacro").symlink_to(package / "nowhere")
    before = {*package.rglob("*")}
    refused = {
        ".a.urdf": "Name it as",
        "../a.urdf": "Name it as",
        ".vscode/a.xml": "Name it as",
        "urdf/a.sh": "Name it as",
        "urdf/leg.xacro": "is there already",
        "gone.xacro": "is there already",
        "out/a.urdf": "outside of the package",
    }
    for name, why in refused.items():
        editor.client.act("model/create", name)
        editor.client.wait_until(lambda why=why: why in editor.notice)
    assert {*package.rglob("*")} == before
    # A text may include a file before it is there.
    name = "urdf/parts/hand.xacro"
    editor.replace("</robot>", '<xacro:include filename="parts/hand.xacro"/>\n</robot>')
    assert any("hand.xacro" in problem["message"] for problem in editor.problems())
    editor.client.act("model/create", name)
    editor.client.wait_until(lambda: editor.value("text")["file"] == name)
    assert (package / name).read_bytes() == b"" and editor.text == ""
    editor.client.act("model/type", name, 0, 0, 0, LEG.replace("leg", "hand"), False)
    editor.client.wait_until(lambda: '"hand"' in editor.text)
    editor.replace('"k"', '"h"')
    editor.client.wait_until(lambda: "hand" in editor.links)
    editor.client.act("model/save", name)
    editor.client.wait_until((package / name).read_text)


def test_the_bundled_robot_gets_no_new_files(
    edit: Callable[..., Editor], show: Callable[..., Visualizer]
) -> None:
    editor = edit(show(bundled.model_path(), edit=True))
    assert "model/save" in editor.client.rows
    assert "model/create" not in editor.client.rows


def test_viewers_read_and_who_has_control_writes(
    edit: Callable[..., Editor],
) -> None:
    teacher = edit(presenter="teach-the-class", path="/?token=teach-the-class")
    viewer = edit(teacher.viz)
    shown = viewer.value("text")
    viewer.client.act("model/type", shown["file"], shown["version"], 0, 0, "x", False)
    viewer.client.wait_until(lambda: viewer.notice.startswith("View only"))
    teacher.replace('name="j"', 'name="jj"')
    viewer.client.wait_until(lambda: viewer.text == GOOD.replace('"j"', '"jj"'))


def test_each_private_session_has_its_own_text(edit: Callable[..., Editor]) -> None:
    one = edit(session="private")
    other = edit(one.viz)
    one.replace('name="j"', 'name="jj"')
    assert (one.problems(), other.text) == ([], GOOD)
    assert "model/save" not in one.client.rows


def test_a_click_on_a_link_finds_its_lines_in_the_file_that_has_it(
    edit: Callable[..., Editor],
) -> None:
    editor = edit()
    for link, name in (("leg", "urdf/leg.xacro"), ("arm", MODEL)):
        editor.client.act("model/find", link)
        editor.client.wait_until(lambda name=name: editor.value("text")["file"] == name)
        wanted = editor.value("wanted")
        start, end = (2 * at for at in wanted["extent"])
        units = editor.text.encode("utf-16-le")
        assert units[start:end].decode("utf-16-le") == f'<link name="{link}"/>'
    editor.client.act("model/find", "no_link")
    editor.client.wait_until(lambda: "no_link" in editor.notice)


def test_a_link_of_a_macro_leads_to_the_macro_and_to_its_call(
    edit: Callable[..., Editor], package: Path
) -> None:
    macro = """<xacro:macro name="leg" params="n"><link name="leg_${n}"/>
    <joint name="j${n}" type="fixed"><parent link="hull"/>
    <child link="leg_${n}"/></joint></xacro:macro></robot>"""
    (package / "urdf/leg.xacro").write_text(f"{HEAD}\n{macro}")
    call = '<xacro:leg n="2"/>'
    text = GOOD.replace("</robot>", f'<xacro:leg n="1"/>\n  {call}\n</robot>')
    (package / MODEL).write_text(text, encoding="utf-8")
    editor = edit()
    editor.client.act("model/find", "leg_2")
    editor.client.wait_until(lambda: editor.value("text")["file"] == "urdf/leg.xacro")
    line = text[: text.index(call)].count("\n") + 1
    assert editor.value("wanted")["call"] == f"{MODEL} line {line}"
    start, end = editor.value("wanted")["extent"]
    assert editor.text[start:end] == '<link name="leg_${n}"/>'
    editor.client.act("model/call", "leg_2")
    editor.client.wait_until(lambda: editor.value("text")["file"] == MODEL)
    units = editor.text.encode("utf-16-le")
    start, end = (2 * at for at in editor.value("wanted")["extent"])
    assert units[start:end].decode("utf-16-le") == call


def test_the_expanded_text_follows_what_is_typed(
    edit: Callable[..., Editor], package: Path
) -> None:
    editor = edit(presenter="teach-the-class", path="/?token=teach-the-class")
    editor.client.act("model/expand", True)
    editor.client.wait_until(lambda: editor.value("expanded") is not None)
    assert '<link name="leg"/>' in editor.value("expanded")
    # A presenter shows it to others: no folder of the server is in it.
    assert str(package.parent) not in editor.value("expanded")
    editor.replace('name="arm"/>', 'name="${1+1}"/>')
    editor.replace('child link="arm"', 'child link="2"')
    editor.client.wait_until(lambda: '<link name="2"/>' in editor.value("expanded"))
    editor.client.act("model/expand", False)
    editor.client.wait_until(lambda: editor.value("expanded") is None)


def test_a_text_for_an_older_version_is_not_taken(edit: Callable[..., Editor]) -> None:
    editor = edit()
    editor.replace('name="j"', 'name="jj"')
    now = editor.value("text")
    editor.client.act("model/type", MODEL, now["version"] - 1, 0, 0, "x", False)
    editor.client.settle(viser_server(editor.viz))
    assert editor.value("text") == now
    for start, end, new in ((0, 10**9, ""), (9, 3, ""), (0, 0, "x" * 20_000)):
        editor.client.act("model/type", MODEL, now["version"], start, end, new, True)
    editor.client.act("model/open", "../../etc/passwd")
    editor.client.wait_until(lambda: editor.notice == "This file is no longer there")


def test_a_text_that_is_too_long_or_no_text_is_refused(
    edit: Callable[..., Editor], package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package / "urdf" / "leg.xacro").write_bytes(b"\xff\xfe\x00<")
    lower(monkeypatch, "EDITED_TEXT", 1000)
    editor = edit()
    assert editor.value("text")["most"] == 1000
    editor.client.act("model/type", MODEL, 0, 0, 0, "x" * 999, False)
    editor.client.wait_until(lambda: "1,000 at most" in editor.notice)
    assert editor.text == GOOD
    editor.open("urdf/leg.xacro")
    assert editor.text == "" and "encoding" in editor.value("text")["why"]


def test_code_in_a_text_of_who_may_not_save_is_not_run(
    edit: Callable[..., Editor],
) -> None:
    editor = edit()
    code = "${''.__class__.__mro__[1].__subclasses__()}"
    editor.replace('<link name="hull"/>', f'<link name="{code}"/>')
    (problem,) = (p for p in editor.problems() if p["severity"] == "error")
    assert "untrusted" in problem["message"] or "not allowed" in problem["message"]
    assert editor.links == {"hull", "arm", "leg"}
