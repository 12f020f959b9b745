"""A reference beside the robot: the table of what differs, its ghost, and its file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from inside import session_of, viser_server
from lower_limit import lower
from protocol_client import ProtocolClient, Received
from written import write_wanted

from sambot_viz import RobotError, UsageError, Visualizer, load_robot
from sambot_viz.cli import main
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options

WHEEL = """<link name="{side}"><visual><geometry><sphere radius="0.1"/></geometry>
</visual></link><joint name="{side}_joint" type="continuous"><parent link="base"/>
<child link="{side}"/><origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/></joint>"""
BASE = """<robot name="r"><link name="base"><visual><geometry><box size="1 1 1"/>
</geometry></visual></link>"""
LEFT, RIGHT = (WHEEL.format(side=s, x=0, y=y) for s, y in (("left", 1), ("right", -1)))
MINE = f"{BASE}{LEFT}{RIGHT}</robot>"
MOVED = MINE.replace('xyz="0 1 0"/><axis', 'xyz="0.03 1 0"/><axis')
ORIGIN = ["joint left_joint", "origin", "0 1000 0 mm", "30 1000 0 mm", "30 mm"]


class Page:
    """A page that shows a table."""

    def __init__(self, viz: Visualizer, client: ProtocolClient) -> None:
        self.viz, self.client = viz, client

    @property
    def table(self) -> list[list[str]]:
        found = self.value("compare/found") or []
        columns = ("whose", "what", "mine", "theirs", "apart")
        return [[one[name] for name in columns] for one in found]

    def value(self, row_id: str) -> Any:
        return self.client.rows.get(row_id, {}).get("value")

    def reads(self, table: list[list[str]]) -> None:
        self.client.wait_until(lambda: self.table == table)

    def note(self, said: str) -> None:
        self.client.wait_until(lambda: self.value("compare/note") == said)

    def ghosts(self) -> list[Received]:
        """What is drawn in the colour of the ghost, at the moment."""
        self.client.settle(viser_server(self.viz))
        there: dict[str, Received] = {}
        for message in self.client.messages:
            name = message.fields.get("name", "")
            if message.type == "RemoveSceneNodeMessage":
                there = {
                    n: m for n, m in there.items() if not f"{n}/".startswith(f"{name}/")
                }
            elif message.type in ("BoxMessage", "IcosphereMessage", "MeshMessage"):
                if "/~r" in name:
                    there[name] = message
        return list(there.values())

    def look(self, ghost: Received) -> dict[str, Any]:
        """What was set after the node was made."""
        updates: dict[str, Any] = {}
        for message in self.client.messages:
            if message.type == "SceneNodeUpdateMessage":
                if message.fields["name"] == ghost.fields["name"]:
                    updates |= message.fields["updates"]
        return updates

    def moved(self, joint: str) -> int:
        """Move a joint a step; return how many poses that has sent."""
        self.client.settle(viser_server(self.viz))
        mark = self.client.mark()
        self.viz.set_joint_positions({joint: 0.5})
        self.client.settle(viser_server(self.viz))
        return self.client.types(mark)["SetOrientationMessage"]


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    mine, theirs = tmp_path / "mine.urdf", tmp_path / "theirs.urdf"
    mine.write_text(MINE)
    theirs.write_text(MOVED)
    return mine, theirs


@pytest.fixture
def show(
    files: tuple[Path, Path], protocol: Callable[..., ProtocolClient]
) -> Iterator[Callable[..., Page]]:
    with ExitStack() as stack:

        def start(reference: Any = files[1], **options: Any) -> Page:
            asked = Options(files[0], watch=True, reference=reference, **options)
            inputs = Inputs(asked, may_be_broken=True)
            viz = stack.enter_context(Visualizer.of_inputs(inputs))
            client = protocol(viz.viser.get_port())
            client.settle(viser_server(viz))
            return Page(viz, client)

        yield start


def test_a_moved_wheel_is_one_row_and_the_only_ghost(
    show: Callable[..., Page],
) -> None:
    page = show()
    page.reads([ORIGIN])
    assert page.value("compare/with") == "Reference theirs.urdf"
    (row,) = page.value("compare/found")
    assert row["places"] == "Mine: mine.urdf:3, Theirs: theirs.urdf:3"
    (ghost,) = page.ghosts()
    assert page.look(ghost) == {"color": [255, 64, 200], "opacity": 0.5}


def test_only_what_differs_sends_a_pose_more(show: Callable[..., Page]) -> None:
    page = show()
    page.reads([ORIGIN])
    assert page.moved("right_joint") == 1
    assert page.moved("left_joint") == 2


def test_of_many_differences_the_first_are_listed(
    show: Callable[..., Page], files: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "COMPARE_ROWS", 1)
    files[1].write_text(MOVED.replace("1 1 1", "1 1 2"))
    page = show()
    page.note("2 differences; the first 1 are listed")
    assert [row[:2] for row in page.table] == [["link base", "visual size"]]


def test_the_ghost_can_be_hidden_and_nothing_compared(
    show: Callable[..., Page],
) -> None:
    page = show()
    page.reads([ORIGIN])
    page.client.edit("compare/ghost", False)
    page.client.wait_until(lambda: page.value("compare/ghost") is False)
    assert page.ghosts() == []
    page.client.edit("compare/ghost", True)
    page.client.edit("compare/with", "Nothing")
    page.reads([])
    assert page.ghosts() == []
    assert page.moved("left_joint") == 1


def test_a_saved_reference_and_a_saved_model_are_compared_again(
    show: Callable[..., Page], files: tuple[Path, Path]
) -> None:
    page = show()
    page.reads([ORIGIN])
    files[1].write_text(MINE)
    page.reads([])
    page.note("The models are the same.")
    assert page.ghosts() == []
    files[0].write_text(f"{BASE}{RIGHT}</robot>")
    page.reads(
        [
            ["link left", "", "none", "there", ""],
            ["joint left_joint", "", "none", "there", ""],
        ]
    )
    assert len(page.ghosts()) == 1


def test_a_mistake_in_the_reference_is_one_problem_and_the_robot_stays(
    show: Callable[..., Page], files: tuple[Path, Path]
) -> None:
    files[1].write_text("<robot name='r'>\n<link name='a'>\n</robot>")
    page = show()
    page.note("The other model cannot be read: see Problems.")
    listed = session_of(page.viz).problems.shown.value.listed
    (problem,) = (p for p in listed if p.file == str(files[1]))
    assert (problem.severity, problem.line) == ("error", 2) and problem.hint
    assert session_of(page.viz).robot.model is not None
    files[1].write_text(MOVED)
    page.reads([ORIGIN])
    assert not session_of(page.viz).problems.of_saves["reference"]
    # While a later save has a mistake, the last one that worked stays.
    files[1].write_text("<robot")
    page.client.wait_until(
        lambda: bool(session_of(page.viz).problems.of_saves["reference"])
    )
    assert page.table == [ORIGIN]


def test_a_text_is_compared_with_what_is_saved(show: Callable[..., Page]) -> None:
    page = show(None)
    client = page.client
    client.edit("compare/with", "The saved text")
    page.note("The models are the same.")
    client.act("model/show", True)
    client.wait_until(lambda: page.value("model/text") is not None)
    shown = page.value("model/text")
    at = shown["text"].index('xyz="0 1 0"/><axis') + len('xyz="')
    client.act("model/type", shown["file"], shown["version"], at, at + 1, "0.03", False)
    mine, theirs = ORIGIN[3], ORIGIN[2]
    page.reads([[*ORIGIN[:2], mine, theirs, ORIGIN[4]]])
    assert len(page.ghosts()) == 1
    write_wanted(client, "model/revert", shown["file"])
    page.note("The models are the same.")
    assert page.ghosts() == []


def test_each_private_session_has_its_own_choice(
    show: Callable[..., Page], protocol: Callable[..., ProtocolClient]
) -> None:
    page = show(session="private")
    page.reads([ORIGIN])
    other = Page(page.viz, protocol(page.viz.viser.get_port()))
    other.client.settle(viser_server(page.viz))
    other.reads([ORIGIN])
    other.client.edit("compare/with", "Nothing")
    other.reads([])
    assert page.table == [ORIGIN]


def test_a_copy_begins_with_the_choice_of_the_others(
    show: Callable[..., Page], protocol: Callable[..., ProtocolClient]
) -> None:
    page = show()
    page.reads([ORIGIN])
    page.client.edit("compare/ghost", False)
    page.client.wait_until(lambda: page.value("compare/ghost") is False)
    other = Page(page.viz, protocol(page.viz.viser.get_port(), path="/copy"))
    other.client.wait_until(lambda: other.value("compare/ghost") is False)
    other.reads([ORIGIN])
    other.client.edit("compare/with", "Nothing")
    other.reads([])
    assert page.table == [ORIGIN]


def test_a_model_that_is_broken_from_the_start_is_compared_once_it_is_fixed(
    show: Callable[..., Page], files: tuple[Path, Path]
) -> None:
    files[0].write_text("<robot/>")
    page = show()
    page.note("There is no robot yet.")
    files[0].write_text(MINE)
    page.reads([ORIGIN])


def test_a_program_gives_a_file_or_a_robot(files: tuple[Path, Path]) -> None:
    reference = load_robot(files[1])
    for given in (reference, str(files[1]), files[1]):
        with Visualizer(files[0], reference=given, port=0) as viz:
            comparison = session_of(viz).comparison
            assert comparison.wait(10.0)
            assert [one.name for one in comparison.found or ()] == ["left_joint"]
    with pytest.raises(UsageError, match=r"no model .*there is no such file"):
        Visualizer(files[0], reference=files[1].with_name("their.urdf"), port=0)
    files[1].write_text("<robot/>")
    with pytest.raises(RobotError):
        Visualizer(files[0], reference=files[1], port=0)


def test_a_picture_of_a_broken_reference_is_refused(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    files[1].write_text("<robot/>")
    picture = str(files[1].with_suffix(".png"))
    words = ["snapshot", str(files[0]), "--reference", str(files[1]), "-o", picture]
    assert main(words) == 1
    assert f"{files[1]}:1:1: error[" in capsys.readouterr().err
