"""Apply in Problems: whose press writes which fix into which file."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from inside import session_of, viser_server
from protocol_client import ProtocolClient

from sambot_viz import UsageError, Visualizer, bundled
from sambot_viz.errors import Edit
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.session.model_edits import ModelEdits

Protocol = Callable[..., ProtocolClient]
Show = Callable[..., Visualizer]
Page = Callable[..., ProtocolClient]
APPLY = "problems/apply"
HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
GOOD = f"""{HEAD}\r
<link name="hull"/>\r
<link name="arm"/><!-- ä -->\r
<joint name="j" type="fixed"><parent link="hull"/><child link="arm"/></joint>\r
</robot>\r
"""
BAD = GOOD.replace('<parent link="hull"/>', '<parent link="hul"/>')
# ROS takes this one, so that it is shown without following its file.
DOUBTFUL = GOOD.replace("</joint>", '<origin xzy="0 0 1"/></joint>')
SURE = DOUBTFUL.replace("xzy", "xyz")
APPLIED = 'Applied: write link="hull" in r.urdf line 4'


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "package"
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>package</name></package>")
    return folder


@pytest.fixture
def model(package: Path) -> Path:
    file = package / "urdf" / "r.urdf"
    file.write_bytes(BAD.encode())
    return file


@pytest.fixture
def show(model: Path) -> Iterator[Callable[..., Visualizer]]:
    """Show a model with a mistake: ``show(edit=True)``."""
    with ExitStack() as stack:

        def start(path: Path = model, **options: Any) -> Visualizer:
            given = Options(path, **{"edit": True, "watch": True, **options})
            inputs = Inputs(given, may_be_broken=True)
            return stack.enter_context(Visualizer.of_inputs(inputs))

        yield start


@pytest.fixture
def page(protocol: Protocol) -> Callable[..., ProtocolClient]:
    def open_page(viz: Visualizer, path: str = "/") -> ProtocolClient:
        client = protocol(viz.viser.get_port(), path=path)
        client.settle(viser_server(viz))
        return client

    return open_page


def notice(client: ProtocolClient) -> str:
    return client.rows.get("notice", {}).get("value", {}).get("text", "")


def buttons(client: ProtocolClient) -> list[Any]:
    return [row["act"] for row in client.rows.values() if "act" in row]


def codes(viz: Visualizer) -> list[str]:
    listed = session_of(viz).problems.shown.value.listed
    return [problem.code for problem in listed]


def unfold(client: ProtocolClient) -> None:
    """Unfold the only problem there is."""
    client.wait_until(lambda: client.row("problems/count")["value"]["warning"] == 1)
    (row,) = (r["id"] for r in client.rows.values() if r.get("place") == "r.urdf:4")
    client.act("problems/unfold", row)
    client.wait_until(lambda: len(buttons(client)) == 1)


def press(client: ProtocolClient) -> None:
    """Press the only button there is."""
    ((label, command, row),) = buttons(client)
    assert (label, command) == ("Apply", APPLY)
    client.act(command, row)


def test_a_press_writes_the_fix_and_the_robot_follows(
    show: Show, page: Page, model: Path
) -> None:
    viz = show()
    client = page(viz)
    assert codes(viz) == ["joint-parent-unknown"]
    press(client)
    client.wait_until(lambda: notice(client) == APPLIED)
    assert model.read_bytes() == GOOD.encode()
    client.wait_until(lambda: codes(viz) == [])
    client.wait_until(lambda: session_of(viz).robot.model is not None)
    robot = session_of(viz).robot.model
    assert robot is not None and robot.joints["j"].parent == "hull"
    client.wait_until(lambda: not buttons(client))


def test_a_mended_warning_does_not_linger_beside_the_error_that_it_uncovers(
    show: Show, page: Page, model: Path
) -> None:
    wrong = '<robot name="r">\n<xacro:proprty name="a" value="1"/>\n\n<link name="l"/>'
    model.write_text(f"{wrong}\n</robot>\n")
    viz = show()
    client = page(viz)
    client.wait_until(lambda: len(codes(viz)) == 1)
    (before,) = codes(viz)
    (row,) = (r["id"] for r in client.rows.values() if r.get("place") == "r.urdf:2")
    client.act("problems/unfold", row)
    client.wait_until(lambda: len(buttons(client)) == 1)
    press(client)
    client.wait_until(lambda: notice(client).startswith("Applied"))
    client.wait_until(lambda: codes(viz) and before not in codes(viz))
    # The file as it was has it again.
    client.act("edit/undo")
    client.wait_until(lambda: codes(viz) == [before])


def test_two_presses_before_the_file_is_read_again_are_one(
    show: Show, page: Page, model: Path
) -> None:
    model.write_bytes(DOUBTFUL.encode())
    viz = show(watch=False)
    client = page(viz)
    unfold(client)
    said = (
        'Applied: write xyz="0 0 1" in r.urdf line 4; start the program again to see '
        "it (--no-watch)"
    )
    for number in (1, 2):
        press(client)
        client.settle(viser_server(viz))
        assert client.row("notice")["value"]["number"] == number
        assert notice(client) == said
    assert model.read_bytes() == SURE.encode()


def test_a_press_is_undone_as_long_as_the_file_is_as_it_was_written(
    show: Show, page: Page, model: Path
) -> None:
    model.write_bytes(DOUBTFUL.encode())
    viz = show(watch=False)
    client = page(viz)
    unfold(client)

    def after(command: str) -> str:
        client.act(command)
        client.settle(viser_server(viz))
        return notice(client)

    press(client)
    assert after("edit/undo") == "Undone: Fix in r.urdf"
    assert model.read_bytes() == DOUBTFUL.encode()
    assert after("edit/redo") == "Redone: Fix in r.urdf"
    assert model.read_bytes() == SURE.encode()
    mine = SURE.replace("hull", "body").encode()
    model.write_bytes(mine)
    assert after("edit/undo") == (
        "'Fix in r.urdf' cannot be undone: r.urdf has changed since it was checked"
    )
    assert model.read_bytes() == mine
    assert not session_of(viz).history.modified.value


def test_a_file_that_was_changed_meanwhile_is_left_alone(
    show: Show, page: Page, model: Path
) -> None:
    model.write_bytes(DOUBTFUL.encode())
    viz = show(watch=False)
    client = page(viz)
    unfold(client)
    mine = DOUBTFUL.replace("arm", "leg").encode()
    model.write_bytes(mine)
    press(client)
    client.settle(viser_server(viz))
    assert notice(client) == "r.urdf has changed since it was checked"
    assert model.read_bytes() == mine


def test_a_viewer_presses_in_vain_until_it_has_control(
    show: Show, page: Page, model: Path
) -> None:
    viz = show(presenter="teach-the-class")
    viewer = page(viz)
    press(viewer)
    viewer.settle(viser_server(viz))
    assert notice(viewer).startswith("View only")
    assert model.read_bytes() == BAD.encode()
    press(page(viz, "/?token=teach-the-class"))
    viewer.wait_until(lambda: model.read_bytes() == GOOD.encode())


def test_without_the_option_there_is_only_the_text_to_copy(
    show: Show, page: Page, model: Path
) -> None:
    viz = show(edit=False)
    client = page(viz)
    assert buttons(client) == []
    (hint,) = (r for r in client.rows.values() if r.get("name") == "the fix")
    assert hint["value"] == 'To fix it: write link="hull"'
    assert hint["copy"] == "hull"
    assert APPLY not in client.rows
    client.act(APPLY, hint["in"])
    client.settle(viser_server(viz))
    assert notice(client) == "This no longer exists"
    assert model.read_bytes() == BAD.encode()


def test_a_private_copy_writes_no_files(show: Show, page: Page, model: Path) -> None:
    viz = show()
    copy = page(viz, "/copy")
    copy.wait_until(lambda: "people/state" in copy.rows)
    assert copy.row("people/state")["value"]["copy"] is True
    assert buttons(copy) == [] and APPLY not in copy.rows
    assert model.read_bytes() == BAD.encode()


def test_what_is_not_in_the_package_of_the_model_is_not_offered(
    show: Show, page: Page, model: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other.xacro"
    other.write_bytes(BAD.encode())
    model.write_text(f'{HEAD}<xacro:include filename="../../other.xacro"/></robot>')
    viz = show(model.rename(model.with_suffix(".xacro")))
    client = page(viz)
    assert codes(viz) == ["joint-parent-unknown"]
    assert buttons(client) == []
    # What is in the package beside the model is.
    beside = model.parents[1] / "beside.xacro"
    beside.write_bytes(BAD.encode())
    model.with_suffix(".xacro").write_text(
        f'{HEAD}<xacro:include filename="../beside.xacro"/></robot>'
    )
    client.wait_until(lambda: bool(buttons(client)))
    press(client)
    client.wait_until(lambda: notice(client) == APPLIED.replace("r.urdf", beside.name))
    assert other.read_bytes() == BAD.encode()


def test_a_link_of_a_workspace_leads_to_the_package_of_its_source(
    show: Show, page: Page, model: Path, tmp_path: Path
) -> None:
    installed = tmp_path / "install" / "r.urdf"
    installed.parent.mkdir()
    installed.symlink_to(model)
    client = page(show(installed))
    press(client)
    client.wait_until(lambda: notice(client) == APPLIED)
    assert model.read_bytes() == GOOD.encode()
    assert installed.is_symlink()


def test_the_robots_of_the_program_are_not_changed() -> None:
    edits = ModelEdits(bundled.model_path(), watched=True)
    file = str(bundled.model_path())
    assert not edits.may_write([Edit(file, 0, 0, "x")])


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ({"session": "private"}, "--edit needs a robot that all browsers share"),
        ({"trusted": False}, "--edit changes files, and --untrusted"),
    ],
)
def test_strangers_and_what_they_made_change_no_files(
    options: dict[str, Any], why: str
) -> None:
    with pytest.raises(UsageError, match=why):
        Options(edit=True, **options)
