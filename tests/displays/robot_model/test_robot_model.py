"""RobotModel: what a file says about single links and joints, and a second robot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import viser
from patience import patience

from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.frames import Transform
from sambot_viz.robot.model import Robot
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.session import Session

Show = Callable[..., Session]
Nodes = Callable[[Session], dict[str, viser.SceneNodeHandle]]


def model_of(session: Session) -> RobotModelDisplay:
    display = session.scene.displays[0]
    assert isinstance(display, RobotModelDisplay)
    return display


def at(session: Session, link: str, nodes: Nodes) -> dict[str, viser.SceneNodeHandle]:
    """The nodes of the display at a link's frame, by the part after its key."""
    above = f"{session.scene.context.nodes.path(link)}/{model_of(session).key}"
    found = nodes(session).items()
    return {n[len(above) :]: h for n, h in found if n.startswith(above)}


LINKS = """
      Links:
        All Links Enabled: true
        Link Tree Style: Links in Alphabetic Order
        base: {Alpha: 0.4, Show Axes: true, Show Trail: false, Value: true}
        upper: {Alpha: 1, Show Axes: false, Show Trail: false, Value: false}
"""
LINK_TREE = """
      Link Tree:
        Link Tree Style: Tree of links
        base:
          Details: {Alpha: 0.4, Show Axes: true, Show Trail: false}
          Value: true
          upper:
            Details: {Alpha: 1, Show Axes: false, Show Trail: false}
            Value: false
            tool: {Details: {Show Axes: false}}
"""
BOTH_TREE = """
      Link/Joint Tree:
        Link Tree Style: Tree of links and joints
        base:
          Details: {Alpha: 0.4, Show Axes: true, Show Trail: false}
          Value: true
          shoulder:
            Details: {Show Axes: true, Show Joint Axis: true}
            Value: false
            upper: {Details: {Alpha: 1}, Value: false}
"""


@pytest.mark.parametrize("body", [LINKS, LINK_TREE, BOTH_TREE])
def test_links_look_as_the_file_says_whatever_the_style(
    body: str, show: Show, nodes: Nodes
) -> None:
    session = show(body)
    base, upper = at(session, "base", nodes), at(session, "upper", nodes)
    box: Any = base["v0"]
    assert box.opacity == pytest.approx(0.5 * 0.4)
    assert "a" in base
    assert "v0" not in upper


def test_the_list_of_joints_switches_their_child_links(
    show: Show, nodes: Nodes
) -> None:
    session = show("      Joints: {shoulder: {Value: false, Show Axes: true}}")
    assert "v0" not in at(session, "upper", nodes)
    assert any(name.startswith("j") for name in at(session, "base", nodes))


def test_joint_axes_and_arrows_stand_at_the_joints_origin(
    show: Show, nodes: Nodes
) -> None:
    session = show(BOTH_TREE)
    marks = at(session, "base", nodes)
    axes = next(handle for name, handle in marks.items() if name.startswith("j"))
    assert tuple(axes.position) == pytest.approx((0, 0, 1))
    arrow: Any = next(handle for name, handle in marks.items() if name.startswith("x"))
    # The joint turns about its y, which its origin's roll has made the parent's z.
    assert arrow.batched_positions[0] == pytest.approx((0, 0, 1.075), abs=1e-5)


def test_links_the_file_does_not_name_follow_all_links_enabled(
    show: Show, nodes: Nodes
) -> None:
    session = show("      Links: {All Links Enabled: false, upper: {Value: true}}")
    assert "v0" not in at(session, "base", nodes)
    assert "v0" in at(session, "upper", nodes)


def test_all_links_enabled_ticks_the_links_of_the_file_too(
    show: Show, nodes: Nodes
) -> None:
    session = show(LINKS)
    display = model_of(session)
    session.display_edits.set_property(display, "Links/All Links Enabled", False)
    assert not any(
        h.visible
        for link in ("base", "upper")
        for h in at(session, link, nodes).values()
    )
    session.display_edits.set_property(display, "Links/All Links Enabled", True)
    assert at(session, "upper", nodes)["v0"].visible
    assert display.config.dynamic(("Links", "upper"))["Value"] == "true"


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ("", ("Links", "upper")),
        (LINKS, ("Links", "upper")),
        (LINK_TREE, ("Link Tree", "base", "upper", "Details")),
        (BOTH_TREE, ("Link/Joint Tree", "base", "shoulder", "upper", "Details")),
    ],
)
def test_a_change_is_written_where_the_style_has_the_link(
    body: str, place: tuple[str, ...], show: Show
) -> None:
    display = model_of(show(body))
    links = display.entries()[0]
    links.set("upper", "Alpha", 0.25)
    assert display.config.dynamic(place)["Alpha"] == "0.25"
    assert links.item("upper").get("Alpha") == 0.25


def test_an_edit_of_a_link_changes_one_line_of_the_file(show: Show) -> None:
    body = """
      Links:
        base:
          Alpha: 0.40  # as written by hand
          Show Axes: yes
        upper: {Alpha: 7, Value: false}
"""
    session = show(body.strip("\n"))
    before = session.document.config.to_yaml().splitlines()
    links = model_of(session).entries()[0]
    assert links.set("upper", "Alpha", 1.0) == 1.0
    assert links.set("base", "Show Axes", True) is True
    assert session.document.config.to_yaml().splitlines() == before
    assert links.set("base", "Alpha", 0.25) == 0.25
    after = session.document.config.to_yaml().splitlines()
    assert [pair for pair in zip(before, after, strict=True) if pair[0] != pair[1]] == [
        (
            "          Alpha: 0.40  # as written by hand",
            "          Alpha: 0.25  # as written by hand",
        )
    ]


def test_a_bad_value_of_a_link_is_reported_once_with_its_line(show: Show) -> None:
    session = show("      Links: {upper: {Alpha: 7}}")
    for _ in range(2):
        with session.change():
            session.document.config.duplicate(session.scene.displays[0].config)
            session.document.show()
    said = [str(problem) for problem in session.document.config.problems]
    assert said == [
        "7:30: warning[config-value]: 'Alpha' is 7, but must be a number from 0 to 1; "
        "1 is used, as in RViz; write a number from 0 to 1"
    ]


def test_a_link_of_a_list_is_switched_on_alone(show: Show, nodes: Nodes) -> None:
    session = show("      Links: {All Links Enabled: false}")
    display = model_of(session)
    links, joints = display.entries()
    assert joints.item("shoulder").get("Value") is False
    links.set("upper", "Value", True)
    display.draw()
    assert "v0" in at(session, "upper", nodes)
    assert "v0" not in at(session, "base", nodes)
    assert joints.item("shoulder").get("Value") is True
    assert display.config.dynamic(("Links", "upper")) == {"Value": "true"}
    session.display_edits.set_property(display, "Links/All Links Enabled", True)
    assert "v0" in at(session, "base", nodes)


def test_another_style_of_the_rows_is_taken_at_once(show: Show) -> None:
    display = model_of(session := show(""))
    session.display_edits.set_property(
        display, "Links/Link Tree Style", "Tree of links"
    )
    display.entries()[0].set("upper", "Alpha", 0.5)
    place = ("Links", "upper", "Details")
    assert display.config.dynamic(place) == {"Alpha": "0.5"}


def test_a_new_link_of_a_tree_is_written_below_those_above_it(show: Show) -> None:
    display = model_of(show(BOTH_TREE))
    display.entries()[0].set("tool", "Show Axes", True)
    place = ("Link/Joint Tree", "base", "shoulder", "upper", "wrist", "tool", "Details")
    assert display.config.dynamic(place)["Show Axes"] == "true"


def test_the_box_of_a_joint_in_a_tree_switches_all_links_below(show: Show) -> None:
    display = model_of(show(BOTH_TREE))
    links, joints = display.entries()
    joints.set("shoulder", "Value", True)
    assert links.item("upper").get("Value") and links.item("tool").get("Value")
    joints.set("shoulder", "Value", False)
    assert not links.item("upper").get("Value") and not links.item("tool").get("Value")


def test_links_and_joints_have_the_rows_and_facts_of_rviz(show: Show) -> None:
    links, joints = model_of(show()).entries()
    assert links.rows and joints.rows
    assert list(links.names) == ["base", "tool", "upper"]
    assert list(links.rows("upper")) == ["Value", "Alpha", "Show Trail", "Show Axes"]
    assert list(links.rows("tool")) == ["Show Trail", "Show Axes"]
    assert "Show Joint Axis" in joints.rows("shoulder")
    assert "Show Joint Axis" not in joints.rows("wrist")
    facts = joints.facts("shoulder")
    assert facts["Position"] == "0; 0; 1" and facts["Type"] == "revolute"
    assert facts["Lower Limit"] == "-1"
    assert links.facts("tool")["Position"] == "1; 0; 1"


def test_mass_and_inertia_follow_their_boxes(show: Show, nodes: Nodes) -> None:
    session = show("      Mass Properties: {Mass: true, Inertia: true}")
    base = at(session, "base", nodes)
    ball: Any = base["m"]
    assert ball.scale == pytest.approx(0.0552, abs=1e-4)
    assert tuple(ball.position) == (0, 0, 0.5)
    box: Any = base["i"]
    assert tuple(box.dimensions) == pytest.approx((6**0.5,) * 3)
    session.display_edits.set_property(model_of(session), "Mass Properties/Mass", False)
    assert "m" not in at(session, "base", nodes)
    session.display_edits.set_property(
        model_of(session), "Links/All Links Enabled", False
    )
    assert "i" not in at(session, "base", nodes)


def test_a_trail_grows_behind_a_link_that_moves(show: Show, nodes: Nodes) -> None:
    session = show("      Links: {tool: {Show Trail: true}}")
    for step in range(1, 6):
        session.robot.set_positions({"shoulder": step / 10})
        session.robot.draw_moved()
    name = f"/{model_of(session).key}t0"
    trail: Any = nodes(session)[name]
    assert trail.points.shape[1:] == (2, 3)
    end = session.frames.tree.lookup("base", "tool").translation
    assert trail.points[-1, 1] == pytest.approx(end, abs=1e-6)


def test_a_robot_without_transforms_is_white_at_the_origin(
    show: Show, nodes: Nodes
) -> None:
    session = show(LINKS, fixed="nowhere")
    white: Any = next(h for n, h in nodes(session).items() if n.endswith("v0"))
    assert tuple(white.color) == (255, 255, 255) and white.opacity is None
    rows = model_of(session).status.rows
    assert rows["base"].level == "Error"
    assert rows["base"].text == "No transform from [base] to [nowhere]"


def test_a_tf_prefix_names_the_frames(show: Show) -> None:
    session = show("      TF Prefix: left", fixed="base")
    rows = model_of(session).status.rows
    assert rows["left/base"].text == "No transform from [left/base] to [base]"


SECOND = """
      Description Source: File
      Description File: {file}
      TF Prefix: b
"""


@pytest.fixture
def second(tmp_path: Path) -> str:
    """The properties of a RobotModel with a file of its own."""
    file = tmp_path / "other.urdf"
    file.write_text("the robot comes from the loader of the test")
    return SECOND.format(file=file)


def test_a_robot_from_a_file_brings_its_own_frames(
    show: Show, arm: Robot, second: str
) -> None:
    session = show(second, files={"other.urdf": arm})
    assert {"base", "upper", "b/base", "b/upper", "b/tool"} <= set(
        session.frames.tree.frames
    )
    assert model_of(session).status.rows["b/upper"].level == "Error"
    session.frames.add("base", "b/base", Transform.from_xyz_rpy((2, 0, 0)))
    rows = model_of(session).status.rows
    assert rows["b/upper"].text == "Transform OK"
    at_two = session.frames.tree.lookup("base", "b/upper").translation
    assert at_two == pytest.approx((2, 0, 1))


def test_frames_of_a_second_robot_outlive_a_reload_of_the_first(
    show: Show, arm: Robot, second: str
) -> None:
    session = show(second, files={"other.urdf": arm})
    session.show_robot(arm)
    assert "b/tool" in session.frames.tree.frames
    assert session.scene.context.nodes.path("b/tool") is not None


def test_a_file_that_is_not_there_is_said_in_the_status(show: Show) -> None:
    session = show(SECOND.format(file="/nowhere/at/all.urdf"))
    status = model_of(session).status.rows["URDF"]
    assert status.level == "Error"
    assert status.text == "URDF is empty: no file '/nowhere/at/all.urdf'"


def test_a_file_of_another_machine_is_found_beside_the_robot_that_is_opened_later(
    show: Show, arm: Robot, tmp_path: Path
) -> None:
    (tmp_path / "other.urdf").touch()
    body = SECOND.format(file="/home/ann/pkg/other.urdf")
    session = show(body, files={"other.urdf": arm}, robot=None)
    assert model_of(session).status.rows["URDF"].level == "Error"
    session.show_robot(replace(arm, files=(tmp_path / "opened.urdf",)))
    models = session.scene.context.models
    assert isinstance(models, ModelThread)
    assert models.wait(patience(20.0))
    assert "b/tool" in session.frames.tree.frames


JOINT_ROWS = """
      Links:
        Link Tree Style: Joints in Alphabetic Order
        shoulder: {Show Axes: true, Show Joint Axis: true, Value: false}
"""


def test_joint_rows_that_a_list_of_joints_saved_under_links_are_read(
    show: Show, nodes: Nodes
) -> None:
    session = show(JOINT_ROWS.strip("\n"))
    joints = next(e for e in model_of(session).entries() if e.title == "Joints")
    assert dict(joints.item("shoulder").properties) == {
        "Value": False,
        "Show Axes": True,
        "Show Joint Axis": True,
    }
    key = model_of(session).key
    marks = {name.rpartition("/")[2] for name in nodes(session)}
    assert any(name.startswith(f"{key}j") for name in marks)
    assert any(name.startswith(f"{key}x") for name in marks)
    joints.set("shoulder", "Show Axes", False)
    text = session.document.config.to_yaml()
    assert "shoulder: {Show Axes: false, Show Joint Axis: true, Value: false}" in text
    assert "Joints:" not in text


def test_link_rows_below_a_list_of_joints_are_read_as_well(show: Show) -> None:
    session = show(JOINT_ROWS.strip("\n") + "\n        base: {Alpha: 0.5}")
    links = next(e for e in model_of(session).entries() if e.title == "Links")
    assert links.item("base").get("Alpha") == 0.5


def test_rows_nested_under_links_are_read_in_the_style_of_a_tree(show: Show) -> None:
    body = """
      Links:
        Link Tree Style: Tree of links and joints
        base:
          Value: true
          shoulder:
            Details: {Show Axes: true}
            Value: true
            upper: {Details: {Alpha: 0.25}, Value: true}
"""
    session = show(body.strip("\n"))
    links, joints = model_of(session).entries()
    assert joints.item("shoulder").get("Show Axes") is True
    assert links.item("upper").get("Alpha") == 0.25


def test_an_edit_draws_its_display_only_and_sends_what_it_changes(
    show: Show, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = show(config=TWO_DISPLAYS)
    model, grid = session.scene.displays
    drawn: list[str] = []
    sent: list[str] = []
    for display in (model, grid):
        draw = display.draw
        monkeypatch.setattr(
            display, "draw", lambda d=display, draw=draw: (drawn.append(d.key), draw())
        )
    buffer = session.audience.scene._websock_interface
    queue = buffer.queue_message
    monkeypatch.setattr(
        buffer,
        "queue_message",
        lambda message: (sent.append(type(message).__name__), queue(message)),
    )
    session.display_edits.set_property(model, "Alpha", 0.25)
    assert (drawn, sent) == ([model.key], 2 * ["SceneNodeUpdateMessage"])
    session.display_edits.set_property(model, "Alpha", 0.25)
    assert len(sent) == 2
    session.display_edits.set_property(grid, "Cell Size", 0.5)
    assert drawn == [model.key, model.key, grid.key]
    assert sent.count("GlbMessage") == sent.count("RemoveSceneNodeMessage") == 1
    assert sent.count("SceneNodeUpdateMessage") == 2


TWO_DISPLAYS = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Enabled: true
      Name: Robot
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Grid
  Global Options:
    Fixed Frame: base
"""
