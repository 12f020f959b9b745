"""A class: names, own pages and files, the board, and who may go where."""

from __future__ import annotations

import io
import json
import shutil
import zipfile
from collections.abc import Iterator
from contextlib import closing, suppress
from http.client import HTTPException
from pathlib import Path
from urllib.parse import urljoin, urlsplit
from urllib.request import HTTPCookieProcessor, build_opener

import pytest
from a_class import MODEL, Browser, a_class, shown, write
from lesson_files import BASE
from lower_limit import lower
from patience import until
from protocol_client import ProtocolClient
from websockets.exceptions import InvalidStatus

from sambot_viz import limits
from sambot_viz.classroom.classroom import Classroom
from sambot_viz.errors import ServerError, UsageError

RIGHT = (
    '<robot name="sam_bot"><link name="base_link"><visual><geometry>'
    '<box size="0.42 0.31 0.18"/></geometry></visual></link></robot>'
)
WRONG = RIGHT.replace("0.18", "0.2")


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Classroom]:
    with a_class(tmp_path / "class") as room:
        yield room


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "class"


def test_a_student_comes_with_a_name_and_finds_the_text_again(
    tmp_path: Path, folder: Path
) -> None:
    with a_class(folder) as room, closing(Browser(room)) as ada:
        assert "<title>" in ada.get("").text and not ada.cookie
        got = ada.join(" Ada  李雷ğ ")
        assert (got.status, got.text) == (200, "Ada 李雷ğ")
        cookie = got.headers["Set-Cookie"]
        assert "HttpOnly" in cookie and "SameSite=Lax" in cookie
        page = ada.page()
        write(page, WRONG)
        # Another tab of the same student has the same text.
        other = ada.page()
        other.act("model/show", True)
        other.wait_until(lambda: (shown(other, "model/text") or {}).get("text"))
        assert shown(other, "model/text")["text"] == WRONG
        page.wait_until(
            lambda: people(page) == {"Ada 李雷ğ": True, "Ada 李雷ğ 2": True}
        )
    # What was not written yet is at the end of the program.
    assert (folder / "Ada-李雷ğ" / MODEL).read_text() == WRONG
    with a_class(folder) as room, closing(Browser(room, cookie=ada.cookie)) as again:
        page = again.page()
        page.act("model/show", True)
        page.wait_until(lambda: (shown(page, "model/text") or {}).get("text"))
        assert shown(page, "model/text")["text"] == WRONG


def people(client: ProtocolClient) -> dict[str, bool]:
    """Who is at a page, and whether they may change what is there."""
    rows = [row for row in client.rows.values() if str(row["id"]).startswith("person/")]
    return {str(row["name"]): bool(row.get("control")) for row in rows}


def noticed(client: ProtocolClient) -> str:
    """The last sentence in the status bar of a page."""
    return str((shown(client, "notice") or {}).get("text", ""))


def test_what_is_typed_is_saved_by_itself_and_counts(
    room: Classroom, folder: Path
) -> None:
    with closing(Browser(room)) as ada:
        ada.join("Ada")
        page = ada.page()
        write(page, RIGHT)
        file = folder / "Ada" / MODEL
        page.wait_until(lambda: file.read_text() == RIGHT)
        steps = lambda: shown(page, "lesson/steps")["steps"]  # noqa: E731
        page.wait_until(lambda: [step["passed"] for step in steps()] == [True, False])
        assert not shown(page, "model/text")["changed"]


def test_a_student_adds_a_file_in_the_own_folder_only(
    room: Classroom, folder: Path
) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room, teaches=True)) as teacher:
        ada.join("Ada")
        page, seen = ada.page(), teacher.page("/student/1/")
        page.act("model/show", True)
        for name in ("../Bob/x.urdf", "/x.urdf", ".x.urdf", "a/.b/x.py", "x.sh", MODEL):
            number = (shown(page, "notice") or {}).get("number", 0)
            page.act("model/create", name)
            page.wait_until(
                lambda n=number: (shown(page, "notice") or {}).get("number", 0) > n
            )
        seen.act("model/create", "b.urdf")
        seen.wait_until(lambda: noticed(seen))
        page.act("model/create", "launch/go.launch.py")
        page.wait_until(
            lambda: (shown(page, "model/text") or {})["file"] == "launch/go.launch.py"
        )
        write(page, "import x\n")
        file = folder / "Ada" / "launch" / "go.launch.py"
        page.wait_until(lambda: file.read_text() == "import x\n")
        files = {path.name for path in folder.rglob("*") if path.is_file()}
        assert files == {".sambot-class.json", MODEL, "go.launch.py"}


def test_the_board_follows_each_student(room: Classroom) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room, teaches=True)) as teacher:
        board = teacher.board()
        head = board.head
        assert (head["steps"], head["points"], head["rows"]) == (2, 5, [])
        ada.join("Ada")
        page = ada.page()
        # The file to begin with is empty, which is no mistake of the student.
        board.until(lambda: board.rows and board.rows[1]["errors"])
        assert not board.rows[1]["stuck"]
        write(page, WRONG)
        board.until(lambda: board.rows and "0.42 0.31 0.2" in board.rows[1]["first"])
        board.until(lambda: board.rows[1]["pages"] == 1)
        row = board.rows[1]
        assert (row["name"], row["step"], row["title"]) == ("Ada", 1, "The body")
        page.act("lesson/check")
        board.until(lambda: board.rows[1]["tries"])
        assert board.rows[1]["stuck"]
        ada.close()
        board.until(lambda: not board.rows[1]["pages"])
        assert board.rows[1]["tries"] == 1


def test_a_step_that_is_left_out_is_left_out_on_the_board_and_after_a_restart(
    folder: Path,
) -> None:
    with a_class(folder) as room, closing(Browser(room, teaches=True)) as teacher:
        ada = Browser(room)
        ada.join("Ada")
        page = ada.page()
        board = teacher.board()
        page.act("lesson/show", 2)
        board.until(lambda: board.rows[1]["step"] == 2)
        assert board.rows[1]["name"] == "Ada"
        ada.close()
    with a_class(folder) as room, closing(Browser(room, cookie=ada.cookie)) as again:
        page = again.page()
        assert shown(page, "lesson/steps")["shown"] == 2


def test_who_is_stuck_for_longest_comes_first(room: Classroom) -> None:
    with closing(Browser(room, teaches=True)) as teacher:
        students = [Browser(room) for _ in range(3)]
        for browser, name in zip(students, ("Ada", "Bob", "Cleo"), strict=True):
            browser.join(name)
        pages = [browser.page() for browser in students]
        write(pages[0], RIGHT)
        write(pages[1], RIGHT)
        write(pages[2], "<robot")
        board = teacher.board()
        rows = board.rows

        def in_order() -> bool:
            names = [r["name"] for r in sorted(rows.values(), key=lambda r: r["order"])]
            return names[0] == "Cleo" and not rows[1]["stuck"] and not rows[2]["stuck"]

        board.until(in_order)
        lines = teacher.get("board/class.csv").text.splitlines()
        assert lines[1].startswith("Cleo,Cleo,1,The body")
        for browser in students:
            browser.close()


def test_the_teacher_looks_over_the_shoulder_and_changes_nothing(
    room: Classroom,
) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room, teaches=True)) as teacher:
        ada.join("Ada")
        page = ada.page()
        write(page, WRONG)
        seen = teacher.page("/student/1/")
        seen.act("model/show", True)
        seen.wait_until(lambda: (shown(seen, "model/text") or {}).get("text"))
        assert shown(seen, "model/text")["text"] == WRONG
        write(page, RIGHT)
        seen.wait_until(lambda: shown(seen, "model/text")["text"] == RIGHT)
        for command in (("role/request", ""), ("model/revert", MODEL)):
            number = (shown(seen, "notice") or {}).get("number", 0)
            seen.act(*command)
            seen.wait_until(
                lambda n=number: (shown(seen, "notice") or {}).get("number", 0) > n
            )
        assert shown(page, "model/text")["text"] == RIGHT
        page.wait_until(lambda: people(page) == {"Ada": True, "Teacher": False})


def test_a_student_cannot_send_the_teacher_away(room: Classroom) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room, teaches=True)) as teacher:
        ada.join("Ada")
        page, seen = ada.page(), teacher.page("/student/1/")
        page.wait_until(lambda: "Teacher" in people(page))
        rows = page.rows.values()
        client = next(r["client"] for r in rows if r.get("name") == "Teacher")
        for command in ("role/remove", "role/give"):
            before = (shown(page, "notice") or {}).get("number", 0)
            page.act(command, client)
            page.wait_until(
                lambda n=before: (shown(page, "notice") or {}).get("number", 0) > n
            )
        assert people(page) == {"Ada": True, "Teacher": False} and not seen.closed


@pytest.mark.parametrize("base", ["/", "/lab"])
def test_the_link_of_the_board_lets_a_browser_look_at_students(
    folder: Path, base: str
) -> None:
    with a_class(folder, base_path=base) as room, closing(Browser(room)) as ada:
        ada.join("Ada")
        jar = HTTPCookieProcessor()
        # A browser: it follows where it is sent, and keeps cookies by their paths.
        teacher = build_opener(jar)
        with teacher.open(room.board_url) as board:
            assert urlsplit(board.url).path == f"{base.rstrip('/')}/board/"
            assert not urlsplit(board.url).query
            look = urljoin(board.url, "../student/1/")
        with teacher.open(look) as seen:
            assert seen.status == 200


@pytest.mark.parametrize(
    "name", ["Łukasz", "李雷", "Ольга", "Ada 🤖", "<b>Bob</b> & Co"]
)
def test_a_name_has_letters_of_any_script(room: Classroom, name: str) -> None:
    with closing(Browser(room)) as student:
        assert student.join(name).text == name
        page = student.page()
        page.wait_until(lambda: people(page) == {name: True})


def test_a_page_is_shown_to_all_and_no_longer(room: Classroom) -> None:
    with (
        closing(Browser(room)) as ada,
        closing(Browser(room)) as bob,
        closing(Browser(room, teaches=True)) as teacher,
    ):
        ada.join("Ada")
        bob.join("Bob")
        page, own = ada.page(), bob.page()
        write(page, RIGHT)
        assert bob.get("student/1/").status == 404
        assert teacher.do("show", number=1).status == 200
        own.wait_until(lambda: shown(own, "lesson/teacher")["link"] == "student/1/")
        assert shown(own, "lesson/teacher")["name"] == "Ada"
        page.wait_until(lambda: shown(page, "lesson/teacher")["name"] == "Ada")
        assert shown(page, "lesson/teacher")["link"] == ""
        seen = bob.page("/student/1/")
        seen.wait_until(lambda: people(seen) == {"Ada": True, "Bob": False})
        teacher.do("show", number=0)
        seen.wait_until(lambda: seen.closed)
        own.wait_until(lambda: not shown(own, "lesson/teacher")["link"])
        assert bob.get("student/1/").status == 404


def test_a_message_is_shown_to_one_or_to_all(room: Classroom) -> None:
    with (
        closing(Browser(room)) as ada,
        closing(Browser(room)) as bob,
        closing(Browser(room, teaches=True)) as teacher,
    ):
        ada.join("Ada")
        bob.join("Bob")
        pages = [ada.page(), bob.page()]
        text = "Look <b>here</b>: ü"
        assert teacher.do("say", number=0, text=text).status == 200
        for page in pages:
            page.wait_until(lambda p=page: shown(p, "lesson/teacher")["text"] == text)
            page.wait_until(lambda p=page: noticed(p) == text)
        teacher.do("say", number=2, text="Only you")
        pages[1].wait_until(lambda: noticed(pages[1]) == "Only you")
        assert shown(pages[0], "lesson/teacher")["text"] == text
        assert teacher.do("say", number=0, text=" ").status == 400
        most = limits.CLASS_MESSAGE.value
        assert teacher.do("say", number=0, text="x" * most).status == 200
        assert teacher.do("say", number=0, text="x" * (most + 1)).status == 400
        assert teacher.do("say", number=7, text="x").status == 400


def test_all_is_collected_with_the_grades(room: Classroom) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room, teaches=True)) as teacher:
        ada.join("Ada")
        page = ada.page()
        write(page, RIGHT)
        page.wait_until(lambda: shown(page, "lesson/steps")["steps"][0]["passed"])
        got = teacher.get("board/class.zip")
    archive = zipfile.ZipFile(io.BytesIO(got.content))
    assert set(archive.namelist()) == {
        "class.csv",
        f"Ada/{MODEL}",
        "Ada/.sambot-lesson.json",
        "Ada/grade.json",
    }
    assert archive.read(f"Ada/{MODEL}").decode() == RIGHT
    assert json.loads(archive.read("Ada/grade.json"))["score"] == 2.0


def test_no_cell_of_the_table_is_a_formula(room: Classroom) -> None:
    name = '=HYPERLINK("http://x","y")'
    Browser(room).join(name)
    table = Browser(room, teaches=True).get("board/class.csv").text
    assert '"\'=HYPERLINK(""http://x"",""y"")"' in table


@pytest.mark.parametrize("path", ["board/", "board/rows", "board/class.zip", "board"])
def test_no_student_reaches_the_board(room: Classroom, path: str) -> None:
    ada = Browser(room)
    ada.join("Ada")
    assert ada.get(path).status == 404
    assert ada.do("say", number=0, text="x").status == 404
    assert ada.get(path, Authorization="Bearer guess").status in (401, 404)


def test_a_student_reaches_no_other_session(room: Classroom) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room)) as eve:
        ada.join("Ada")
        ada.page()
        for browser in (eve, Browser(room, cookie="sambot-class-000000=x")):
            assert browser.get("student/1/").status == 404
            with pytest.raises(InvalidStatus):
                browser.page()
        eve.join("Ada")
        with pytest.raises(InvalidStatus):
            eve.page("/student/1/")
        assert eve.get("student/2/").status == 404
        # Whoever one claims to be is not passed on.
        page = eve.page()
        page.wait_until(lambda: people(page) == {"Ada 2": True})


def test_a_model_reads_no_file_of_another_student(
    room: Classroom, folder: Path
) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room)) as eve:
        ada.join("Ada")
        write(ada.page(), RIGHT)
        eve.join("Eve")
        page = eve.page()
        stolen = f'<xacro:include filename="{folder}/Ada/{MODEL}"/>'
        head = '<robot name="x" xmlns:xacro="http://ros.org/wiki/xacro">'
        write(page, f"{head}{stolen}</robot>")
        page.wait_until(lambda: "outside" in json.dumps(shown(page, "model/found")))


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("", "type your name"),
        ("\u200b \u2060", "type your name"),
        ("x" * 41, "a name has at most 40 characters"),
        ("Teacher", "this is what the teacher is called"),
        ("Tеаcher", "this is what the teacher is called"),
    ],
)
def test_a_name_that_cannot_be_says_why(room: Classroom, name: str, said: str) -> None:
    got = Browser(room).join(name)
    assert got.status == 400 and said in got.text


def test_names_of_all_kinds_have_folders_of_their_own(
    room: Classroom, folder: Path
) -> None:
    names = (
        "../../etc",
        "con",
        "李雷",
        "Ada",
        "ada",
        "a/b\\c:d",
        "🤖",
        "x" * 40,
        "Ada",
    )
    for name in names:
        assert Browser(room).join(name).status == 200
    found = {path.name for path in folder.iterdir() if path.is_dir()}
    assert found == {
        *("etc", "student-con", "李雷", "Ada", "ada-2", "a-b-c-d", "student"),
        *("x" * 40, "Ada-3"),
    }


def test_the_class_is_full_some_time(
    room: Classroom, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "CLASS_STUDENTS", 3)
    for number in range(3):
        assert Browser(room).join(f"S{number}").status == 200
    assert "the class is full" in Browser(room).join("One more").text


def test_a_student_has_some_pages_at_a_time(
    room: Classroom, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "CLASS_CONNECTIONS", 2)
    with closing(Browser(room)) as ada, closing(Browser(room)) as bob:
        ada.join("Ada")
        bob.join("Bob")
        # A page has two connections.
        ada.page()
        assert "Too many pages are open" in ada.get("").text
        bob.page()


def test_what_is_no_request_of_ours_is_refused(room: Classroom) -> None:
    ada = Browser(room)
    assert ada.get("join").status == 400
    assert ada.get("", Origin="http://evil.example").status == 403
    assert ada.join("Ada").status == 200
    assert ada.join("Someone else").text == "Ada"
    assert Browser(room).get("join", **{"Sambot-Class": "%ff"}).status == 400


def test_a_process_that_has_died_is_made_again(room: Classroom, folder: Path) -> None:
    with closing(Browser(room)) as ada:
        ada.join("Ada")
        page = ada.page()
        write(page, RIGHT)
        page.wait_until(lambda: (folder / "Ada" / MODEL).read_text() == RIGHT)
        for process in room._processes:  # pyright: ignore[reportPrivateUsage]
            process._process.kill()  # pyright: ignore
        page.wait_until(lambda: page.closed)

        def is_there() -> bool:
            with suppress(HTTPException):
                return ada.get("").status == 200
            return False

        until(is_there, 10.0, "no page")
        again = ada.page()
        again.act("model/show", True)
        again.wait_until(lambda: (shown(again, "model/text") or {}).get("text"))


def test_what_is_too_long_is_not_taken_and_nothing_else_is_lost(
    room: Classroom,
) -> None:
    with closing(Browser(room)) as ada:
        ada.join("Ada")
        page = ada.page()
        write(page, RIGHT)
        text = shown(page, "model/text")
        at, version = len(text["text"]), text["version"]
        # A page sends what was pasted in pieces; more than a file may have is refused.
        piece = "<!--" + "x" * 9_900 + "-->"
        for number in range(110):
            start = at + number * len(piece)
            page.act("model/type", MODEL, version + number, start, start, piece, True)
        page.wait_until(lambda: "at most are taken" in noticed(page), 30.0)
        assert len(shown(page, "model/text")["text"]) < 1_000_000
        write(page, RIGHT)


def test_many_save_at_the_same_time(room: Classroom, folder: Path) -> None:
    students = [Browser(room) for _ in range(8)]
    try:
        for number, browser in enumerate(students):
            browser.join(f"S{number}")
        pages = [browser.page() for browser in students]
        for page in pages:
            write(page, RIGHT)
            page.act("model/save", MODEL)
        for number, page in enumerate(pages):
            file = folder / f"S{number}" / MODEL
            page.wait_until(lambda f=file: f.read_text() == RIGHT, 30.0)
    finally:
        for browser in students:
            browser.close()


def test_a_text_that_cannot_be_saved_is_told(room: Classroom, folder: Path) -> None:
    with closing(Browser(room)) as ada, closing(Browser(room, teaches=True)) as teacher:
        ada.join("Ada")
        page = ada.page()
        file = folder / "Ada" / MODEL
        page.act("model/show", True)
        page.wait_until(lambda: shown(page, "model/text") is not None)
        file.unlink()
        file.mkdir()
        board = teacher.board()
        write(page, RIGHT)
        trouble = board.until(lambda: board.rows[1]["trouble"])
        assert trouble.startswith("not saved: ")


def test_a_lesson_that_is_changed_meanwhile_stays_as_it_was(tmp_path: Path) -> None:
    lesson = tmp_path / "lesson"
    shutil.copytree(BASE, lesson)
    with a_class(tmp_path / "class", lesson) as room:
        with closing(Browser(room)) as ada, closing(Browser(room)) as bob:
            ada.join("Ada")
            ada.page()
            (lesson / "lesson.yaml").write_text("steps: [")
            bob.join("Bob")
            page = bob.page()
            assert shown(page, "lesson/text")["title"] == "The body"


def test_a_folder_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with (
        pytest.raises(UsageError, match="cannot write into"),
        a_class(tmp_path / "file" / "class"),
    ):
        pass
    package = tmp_path / "package"
    package.mkdir()
    (package / "package.xml").write_text("<package><name>p</name></package>")
    with pytest.raises(UsageError, match="is in no package"), a_class(package / "c"):
        pass


def test_a_port_that_is_taken_is_told(room: Classroom, tmp_path: Path) -> None:
    with (
        pytest.raises(ServerError, match="is taken by another program"),
        a_class(tmp_path / "other", port=room.port),
    ):
        pass


def test_a_damaged_list_is_told(room: Classroom, folder: Path) -> None:
    room.stop()
    (folder / ".sambot-class.json").write_text('{"students": [1]}')
    with pytest.raises(UsageError, match="damaged"), a_class(folder):
        pass
