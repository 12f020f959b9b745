"""A copy of the shared robot, of one browser alone."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from inside import session_of, viser_server
from patience import until
from protocol_client import ProtocolClient

from sambot_viz import Visualizer, load_robot
from sambot_viz.session import Session

Protocol = Callable[..., ProtocolClient]
LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


@pytest.fixture
def viz(make_viz: Callable[..., Visualizer]) -> Visualizer:
    return make_viz(presenter="teach-the-class")


@pytest.fixture
def copy(viz: Visualizer, protocol: Protocol) -> ProtocolClient:
    """A browser with a copy, after the class has changed everything once."""
    session = session_of(viz)
    viz.set_joint_positions({LEFT: 1.0})
    viz.set_static_transform("base_link", "lidar", xyz=(0.1, 0.0, 0.2))
    session.display_edits.set_enabled(session.document.config.displays[0], False)
    client = protocol(viz.viser.get_port(), path="/copy")
    client.wait_until(lambda: len(viz.server.sessions.all()) == 2)
    client.wait_until(lambda: "role/me" in client.rows)
    client.settle(viser_server(viz))
    return client


def own(viz: Visualizer) -> Session:
    _, private = viz.server.sessions.all()
    return private


def one_joint(folder: Path, name: str) -> Path:
    """A model with one joint of this name."""
    model = folder / f"{name}.urdf"
    model.write_text(
        f'<robot name="r"><link name="a"/><link name="b"/><joint name="{name}" '
        'type="continuous"><parent link="a"/><child link="b"/></joint></robot>'
    )
    return model


def test_a_copy_begins_as_the_class_is(viz: Visualizer, copy: ProtocolClient) -> None:
    shared, private = viz.server.sessions.all()
    assert copy.shown("joints", LEFT) == 1.0
    assert private.document.config.to_yaml() == shared.document.config.to_yaml()
    assert dict(private.frames.added) == dict(shared.frames.added)
    assert copy.row("people/state")["value"]["copy"] is True
    assert copy.row("role/me")["value"]["control"] is True


def test_those_who_share_the_robot_see_how_many_have_a_copy(
    viz: Visualizer, protocol: Protocol
) -> None:
    viewer = protocol(viz.viser.get_port())

    def copies() -> int:
        return int(viewer.row("people/state")["value"]["copies"])

    viewer.wait_until(lambda: "people/state" in viewer.rows)
    assert copies() == 0
    ones = []
    for number in (1, 2):
        ones.append(protocol(viz.viser.get_port(), path="/copy"))
        viewer.wait_until(lambda number=number: copies() == number)
    # A copy is nobody else's, and a page of the class is not a copy.
    ones[0].wait_until(lambda: "people/state" in ones[0].rows)
    assert ones[0].row("people/state")["value"]["copies"] == 0
    protocol(viz.viser.get_port())
    for number in (1, 0):
        ones.pop().close()
        viewer.wait_until(lambda number=number: copies() == number)


def test_the_robot_of_the_class_is_not_sent_to_a_copy(
    viz: Visualizer, copy: ProtocolClient, protocol: Protocol
) -> None:
    watcher = protocol(viz.viser.get_port())
    watcher.settle(viser_server(viz))
    frames = [m.fields["name"] for m in copy.messages if m.type == "FrameMessage"]
    # Each frame once, by its own session, and all that the class sees.
    assert len(frames) == len(set(frames)) > 5
    assert {n for m in watcher.messages if (n := m.fields.get("name"))} <= {
        m.fields.get("name") for m in copy.messages
    }
    mark = copy.mark()
    viz.set_joint_positions({RIGHT: 0.5})
    watcher.wait_until(lambda: watcher.shown("joints", RIGHT) == 0.5)
    copy.settle(viser_server(viz))
    assert copy.since(mark) == []


def test_what_is_done_in_a_copy_stays_there(
    viz: Visualizer, copy: ProtocolClient
) -> None:
    copy.edit(copy.id_of("joints", LEFT), -1.0)
    grid = copy.row_named("displays", "RobotModel")["id"]
    copy.edit(grid, False)
    copy.settle(viser_server(viz))
    assert own(viz).robot.joints is not None
    assert own(viz).robot.joints.positions[LEFT] == -1.0
    assert viz.joint_positions[LEFT] == 1.0
    shared, private = viz.server.sessions.all()
    assert private.document.config.to_yaml() != shared.document.config.to_yaml()
    copy.act("edit/undo")
    copy.act("edit/undo")
    copy.settle(viser_server(viz))
    assert own(viz).robot.joints.positions[LEFT] == 1.0


def test_a_copy_has_no_disk(viz: Visualizer, copy: ProtocolClient) -> None:
    assert "file/save" not in copy.rows
    assert own(viz).poses.path is None


def test_a_program_moves_the_robot_of_the_class_only(
    viz: Visualizer, copy: ProtocolClient
) -> None:
    viz.set_joint_positions({LEFT: 0.25})
    viz.set_static_transform("base_link", "camera")
    copy.settle(viser_server(viz))
    assert copy.shown("joints", LEFT) == 1.0
    assert "camera" not in own(viz).frames.tree


def test_a_robot_that_was_edited_is_shown_in_copies_too(
    viz: Visualizer, copy: ProtocolClient, tmp_path: Path
) -> None:
    viz.server.sessions.show_robot(load_robot(one_joint(tmp_path, "j")))
    copy.wait_until(lambda: "j/j" in copy.rows)


def test_a_session_keeps_a_model_of_its_own_and_gives_it_to_its_copies(
    viz: Visualizer, copy: ProtocolClient, protocol: Protocol, tmp_path: Path
) -> None:
    arm, leg = (load_robot(one_joint(tmp_path, name)) for name in ("arm", "leg"))
    own(viz).show_robot(arm, own=True)
    viz.server.sessions.show_robot(leg)
    copy.settle(viser_server(viz))
    joints = [session.robot.joints for session in viz.server.sessions.all()]
    assert [list(j.positions) for j in joints if j] == [["leg"], ["arm"]]
    session_of(viz).show_robot(arm, own=True)
    viz.server.sessions.show_robot(leg)
    late = protocol(viz.viser.get_port(), path="/copy/")
    late.wait_until(lambda: "j/arm" in late.rows)


def test_a_copy_ends_with_its_browser(viz: Visualizer, copy: ProtocolClient) -> None:
    threads = threading.active_count()
    copy.close()
    until(lambda: len(viz.server.sessions.all()) == 1)
    until(lambda: threading.active_count() < threads)


def test_the_class_goes_on_when_the_teacher_makes_a_copy(
    viz: Visualizer, protocol: Protocol
) -> None:
    guest = protocol(viz.viser.get_port())
    teacher = protocol(viz.viser.get_port(), path="/copy/?token=teach-the-class")
    teacher.wait_until(lambda: "role/me" in teacher.rows)
    teacher.settle(viser_server(viz))
    guest.settle(viser_server(viz))
    people = [row for id, row in guest.rows.items() if id.startswith("person/")]
    assert [row.get("control") for row in people] == [None]


def test_private_sessions_have_no_copies(protocol: Protocol) -> None:
    with Visualizer(port=0, session="private") as viz:
        client = protocol(viz.viser.get_port(), path="/copy")
        client.wait_until(lambda: len(viz.server.sessions.all()) == 1)
        assert [s.options.session for s in viz.server.sessions.all()] == ["private"]
