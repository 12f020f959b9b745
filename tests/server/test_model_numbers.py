"""Properties and arguments of a model as sliders: moved, written, taken back."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from inside import session_of, viser_server
from protocol_client import ProtocolClient
from written import write_wanted

from sambot_viz import Visualizer
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options

Protocol = Callable[..., ProtocolClient]
HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
MODEL = f"""{HEAD}
<xacro:arg name="mast" default="0.5"/>
<xacro:property name="size" value="0.20"/><!-- ä 🤖 -->
<xacro:property name="half" value="${{size/2}}"/>
<xacro:include filename="leg.xacro"/>
<link name="hull"><visual><geometry>
<box size="1 1 ${{size}}"/></geometry></visual></link>
<joint name="j" type="fixed"><parent link="hull"/><child link="leg"/>
<origin xyz="0 0 $(arg mast)" rpy="0 0 ${{turn}}"/></joint>
<joint name="k" type="fixed"><parent link="hull"/><child link="top"/>
<origin xyz="${{0/size}} 0 ${{half}}"/></joint>
<link name="top"/>
</robot>
"""
LEG = f"""{HEAD}
<xacro:property name="turn" value="0"/>
<link name="leg"/>
</robot>
"""
FILE = "urdf/r.urdf.xacro"


class Page:
    """A page whose panel Model is open."""

    def __init__(self, viz: Visualizer, client: ProtocolClient) -> None:
        self.viz, self.client = viz, client
        client.act("model/show", True)
        client.act("numbers/show", True)
        client.wait_until(lambda: self.rows and self.value("model/text") is not None)

    @property
    def rows(self) -> dict[str, dict[str, Any]]:
        """Row of each number, by what it is called."""
        return {
            row["name"]: row
            for row in self.client.rows.values()
            if row.get("panel") == "numbers" and row["kind"] in ("slider", "readonly")
        }

    def value(self, row_id: str) -> Any:
        return self.client.rows.get(row_id, {}).get("value")

    def has_text(self, text: str) -> bool:
        return self.value("model/text")["text"] == text

    @property
    def has_error(self) -> bool:
        listed = session_of(self.viz).problems.shown.value.listed
        return any(problem.severity == "error" for problem in listed)

    def move(self, name: str, value: float) -> None:
        self.client.edit(self.rows[name]["id"], value)

    def height(self, link: str) -> float:
        """How far a link is above the hull."""
        robot = session_of(self.viz).robot.model
        assert robot is not None
        return round(float(robot.forward_kinematics()[link][2, 3]), 6)

    def until_height(self, link: str, height: float) -> None:
        self.client.wait_until(lambda: self.height(link) == height)


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "package"
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>package</name></package>")
    (folder / FILE).write_text(MODEL, encoding="utf-8")
    (folder / "urdf/leg.xacro").write_text(LEG)
    return folder


@pytest.fixture
def open_page(package: Path, protocol: Protocol) -> Iterator[Callable[..., Page]]:
    with ExitStack() as stack:

        def open_it(
            viz: Visualizer | None = None, path: str = "/", **options: Any
        ) -> Page:
            if viz is None:
                inputs = Inputs(Options(package / FILE, **options), may_be_broken=True)
                viz = stack.enter_context(Visualizer.of_inputs(inputs))
            client = protocol(viz.viser.get_port(), path=path)
            client.settle(viser_server(viz))
            return Page(viz, client)

        yield open_it


def test_a_number_that_is_moved_moves_the_robot_and_leaves_the_text(
    open_page: Callable[..., Page], package: Path
) -> None:
    page = open_page(watch=False, edit=True)
    rows = page.rows
    assert list(rows) == ["mast", "size", "half", "turn"]
    assert [rows[name].get("unit") for name in rows] == ["m", "m", None, "rad"]
    assert rows["half"]["kind"] == "readonly" and rows["half"]["value"] == "${size/2}"
    assert (rows["size"]["low"], rows["size"]["high"]) == (0.02, 0.4)
    page.move("size", 0.3)
    page.until_height("top", 0.15)
    page.move("mast", 0.75)
    page.until_height("leg", 0.75)
    assert page.height("top") == 0.15
    page.client.wait_until(lambda: page.value("numbers/moved") == 2)
    assert page.rows["size"]["bold"] and page.rows["size"]["value"] == 0.3
    # The text is as it was, and not the editor's business.
    assert page.value("model/text")["text"] == MODEL
    assert not page.value("model/text")["changed"]
    # Each move can be undone, and all are taken back together.
    page.client.act("edit/undo")
    page.until_height("leg", 0.5)
    page.client.act("numbers/reset")
    page.until_height("top", 0.1)
    page.client.act("edit/undo")
    page.until_height("top", 0.15)
    page.client.act("numbers/reset")
    page.client.wait_until(lambda: not session_of(page.viz).own_model)
    assert (package / FILE).read_text(encoding="utf-8") == MODEL


def test_moved_numbers_are_written_as_the_editor_of_the_page_does_it(
    open_page: Callable[..., Page],
) -> None:
    page = open_page(watch=False, edit=True)
    for name, value in {"size": 0.25, "mast": 1.0, "turn": 0.5}.items():
        page.move(name, value)
    page.client.wait_until(lambda: page.value("numbers/writable") == 3)
    page.client.act("model/write")
    page.client.wait_until(lambda: page.value("model/wanted") is not None)
    wanted = page.value("model/wanted")
    assert wanted["file"] == FILE and wanted["more"]
    text = MODEL
    for one in reversed(wanted["changes"]):
        start, end = one["from"], one["to"]
        page.client.act(
            "model/type",
            FILE,
            page.value("model/text")["version"],
            start,
            end,
            one["insert"],
            False,
        )
        text = text[:start] + one["insert"] + text[end:]
        page.client.wait_until(partial(page.has_text, text))
    assert 'name="size" value="0.25"' in text and 'name="mast" default="1"' in text
    # What is written is moved no more.
    page.client.wait_until(lambda: page.value("numbers/moved") == 1)
    page.client.act("model/write")
    page.client.wait_until(lambda: page.value("model/wanted")["file"] != FILE)
    assert not page.value("model/wanted")["more"]
    page.until_height("top", 0.125)


def test_undo_after_the_write_undoes_the_write_and_then_the_move(
    open_page: Callable[..., Page],
) -> None:
    page = open_page(watch=False, edit=True)
    page.move("size", 0.25)
    page.until_height("top", 0.125)
    page.client.wait_until(lambda: page.value("numbers/writable") == 1)
    write_wanted(page.client, "model/write")
    written = MODEL.replace('name="size" value="0.20"', 'name="size" value="0.25"')
    page.client.wait_until(partial(page.has_text, written))
    page.client.wait_until(lambda: not page.value("numbers/moved"))
    page.client.act("edit/undo")
    page.client.wait_until(partial(page.has_text, MODEL))
    # As before the write: moved, and not in the text.
    page.client.wait_until(lambda: page.value("numbers/moved") == 1)
    page.client.act("edit/redo")
    page.client.wait_until(partial(page.has_text, written))
    page.client.act("edit/undo")
    page.client.wait_until(lambda: page.value("numbers/moved") == 1)
    page.client.act("edit/undo")
    page.client.wait_until(lambda: not page.value("numbers/moved"))
    page.until_height("top", 0.1)
    assert page.has_text(MODEL)


def test_a_value_that_makes_no_robot_leaves_the_last_one(
    open_page: Callable[..., Page],
) -> None:
    page = open_page(watch=False)
    page.move("size", 0.3)
    page.until_height("top", 0.15)
    page.move("size", 0.0)
    page.client.wait_until(lambda: page.has_error)
    assert page.height("top") == 0.15
    page.move("size", 0.4)
    page.until_height("top", 0.2)
    page.client.wait_until(lambda: not page.has_error)


def test_a_file_that_is_saved_keeps_what_is_moved(
    open_page: Callable[..., Page], package: Path
) -> None:
    page = open_page(watch=True)
    page.move("mast", 0.75)
    page.move("size", 0.4)
    page.until_height("top", 0.2)
    other = MODEL.replace("${size/2}", "${size}").replace("<xacro:inc", "\n<xacro:inc")
    (package / FILE).write_text(other, encoding="utf-8")
    page.until_height("top", 0.4)
    page.until_height("leg", 0.75)
    # One that is gone from the file is moved no more.
    renamed = re.sub(r'(?<=["{/])size\b', "side", MODEL)
    (package / FILE).write_text(renamed, encoding="utf-8")
    page.until_height("top", 0.1)
    page.client.wait_until(lambda: "side" in page.rows)
    assert page.value("numbers/moved") == 1


def test_arguments_of_the_command_line_are_moved_and_not_written(
    open_page: Callable[..., Page],
) -> None:
    page = open_page(watch=False, xacro_args={"mast": "2.0"})
    assert page.rows["mast"]["value"] == 2.0
    page.move("mast", 3.0)
    page.until_height("leg", 3.0)
    page.client.wait_until(lambda: page.value("numbers/moved") == 1)
    assert page.value("numbers/writable") == 0


def test_viewers_see_the_numbers_and_private_sessions_have_their_own(
    open_page: Callable[..., Page],
) -> None:
    secret = "teach-the-class"
    teacher = open_page(watch=False, presenter=secret, path=f"/?token={secret}")
    viewer = open_page(teacher.viz)
    viewer.move("size", 0.3)
    viewer.client.wait_until(
        lambda: str(viewer.value("notice")).count("View only") == 1
    )
    assert viewer.height("top") == 0.1
    teacher.move("size", 0.3)
    viewer.client.wait_until(lambda: viewer.value("numbers/moved") == 1)
    own = open_page(watch=False, session="private")
    own.move("size", 0.3)
    own.client.wait_until(lambda: own.value("numbers/moved") == 1)
    assert open_page(own.viz).value("numbers/moved") == 0
