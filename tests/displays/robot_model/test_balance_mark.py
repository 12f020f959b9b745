"""The balance of a robot, in the view and in the rows of its display."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

import pytest
import viser
from patience import patience

from sambot_viz import viser_private
from sambot_viz.displays.display import Status
from sambot_viz.displays.robot_model import robot_model
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.robot.model import load_robot
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

Show = Callable[..., Session]
Nodes = Callable[[Session], dict[str, viser.SceneNodeHandle]]
BALANCE = "Mass Properties/Balance"

CRANE = load_robot("""
<robot name="crane">
  <link name="base">
    <visual><geometry><box size="0.4 0.4 0.2"/></geometry></visual>
    <inertial>
      <origin xyz="0 0 0"/><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
  </link>
  <link name="hook">
    <inertial>
      <origin xyz="0 0 0"/><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
  </link>
  <link name="lamp">
    <visual><geometry><sphere radius="0.01"/></geometry></visual>
  </link>
  <joint name="boom" type="prismatic">
    <parent link="base"/><child link="hook"/><origin xyz="0 0 0.2"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="spin" type="continuous">
    <parent link="hook"/><child link="lamp"/><axis xyz="0 0 1"/>
  </joint>
</robot>
""")


def model_of(session: Session) -> RobotModelDisplay:
    display = session.scene.displays[0]
    assert isinstance(display, RobotModelDisplay)
    return display


def marks(session: Session, nodes: Nodes) -> dict[str, viser.SceneNodeHandle]:
    """The nodes of the mark at the base: "cm", "cl" and "cf"."""
    above = f"{session.scene.context.nodes.path('base')}/{model_of(session).key}c"
    found = nodes(session).items()
    return {n[len(above) - 1 :]: h for n, h in found if n.startswith(above)}


def move(session: Session, **positions: float) -> None:
    """Move joints, and wait until that is drawn."""
    moved = threading.Event()
    disconnect = connect([session.robot.positions], moved.set)
    session.robot.set_positions(positions)
    assert moved.wait(patience(10.0))
    disconnect()


def facts(session: Session) -> dict[str, str]:
    return dict(model_of(session).facts()["Mass Properties"]())


@pytest.fixture
def sent(monkeypatch: pytest.MonkeyPatch) -> Callable[[Session], set[str]]:
    """``sent(session)``: a set that gets the nodes of what is sent from now on."""

    def watch(session: Session) -> set[str]:
        names = set[str]()
        scene: Any = session.audience.scene
        buffer = scene._websock_interface
        queue = buffer.queue_message

        def watched(message: Any) -> None:
            names.add(message.name)
            queue(message)

        # What has moved before is changed where it is in viser's buffer.
        poses: Any = viser_private.MovingPoses.of(buffer._broadcast_buffer)
        move = poses.move

        def watched_move(*given: Any) -> Any:
            moves = [given] if len(given) > 1 else list(given[0])
            names.update(state.name for state, _, _ in moves)
            return move(*given) if len(given) > 1 else move(moves)

        monkeypatch.setattr(buffer, "queue_message", watched)
        monkeypatch.setattr(poses, "move", watched_move)
        return names

    return watch


def test_the_mark_is_off_at_first_and_drawn_where_the_mass_is(
    show: Show, nodes: Nodes
) -> None:
    session = show(robot=CRANE)
    assert marks(session, nodes) == {}
    session.display_edits.set_property(model_of(session), BALANCE, True)
    assert set(marks(session, nodes)) == {"cm", "cl", "cf"}
    assert marks(session, nodes)["cm"].position == pytest.approx((0, 0, 0.1))
    assert model_of(session).status.rows["Balance"] == Status("Ok", "OK")
    session.display_edits.set_property(model_of(session), BALANCE, False)
    assert marks(session, nodes) == {}
    assert "Balance" not in model_of(session).status.rows


def test_the_mark_follows_the_joints_and_tells_when_the_robot_falls(
    show: Show, nodes: Nodes
) -> None:
    session = show("      Mass Properties: {Balance: true}", robot=CRANE)
    told: list[Status] = []
    connect(
        [session.scene.statuses],
        lambda: told.append(model_of(session).status.rows["Balance"]),
    )
    move(session, boom=0.1)
    assert marks(session, nodes)["cm"].position == pytest.approx((0, 0.05, 0.1))
    assert told == []
    move(session, boom=0.6)
    fallen = Status("Warn", "The robot falls over to the left in this pose")
    assert told == [fallen]


def test_what_does_not_move_the_mass_sends_nothing_for_it(
    show: Show, sent: Callable[[Session], set[str]]
) -> None:
    session = show("      Mass Properties: {Balance: true}", robot=CRANE)
    names = sent(session)
    move(session, spin=1.0)
    # That of the joint.
    assert len(names) == 1


def test_nobody_weighs_a_robot_that_nobody_looks_at(
    show: Show,
    sent: Callable[[Session], set[str]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    weighed: list[object] = []
    weigh = robot_model.weigh

    def counted(*given: Any) -> Any:
        weighed.append(given)
        return weigh(*given)

    monkeypatch.setattr(robot_model, "weigh", counted)
    session = show(robot=CRANE)
    names = sent(session)
    move(session, boom=0.3)
    assert (len(names), len(weighed)) == (1, 0)


def test_the_rows_say_mass_balance_and_what_is_missing(show: Show) -> None:
    session = show(robot=CRANE)
    assert facts(session) == {
        "Total Mass": "4 kg, without lamp, whose mass is not given",
        "Center of Mass": "0; 0; 0.1 m in base",
        "Stands On": "base",
        "Tips Over At": "45 ° to the front, left, rear or right, 200 mm from the edge",
    }
    move(session, boom=-0.2)
    assert (
        facts(session)["Tips Over At"] == "26.57 ° to the right, 100 mm from the edge"
    )
    move(session, boom=-0.6)
    assert facts(session)["Tips Over At"] == (
        "falls over to the right: 100 mm beyond what it stands on"
    )


@pytest.mark.parametrize(
    ("links", "expected"),
    [
        (
            "<link name='world'/><link name='arm'>{mass}{shape}</link>",
            ("the link world, which holds it", "nothing tips it over: it is fixed"),
        ),
        ("<link name='base'/><link name='arm'>{mass}{shape}</link>", ("arm", "0 °")),
        (
            "<link name='base'/><link name='arm'>{mass}</link>",
            ("nothing: no link has a shape", "unknown"),
        ),
    ],
)
def test_a_robot_that_nothing_tips_over_or_supports_says_so(
    links: str, expected: Sequence[str], show: Show
) -> None:
    mass = (
        "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
        "izz='1'/></inertial>"
    )
    shape = "<visual><geometry><sphere radius='0.1'/></geometry></visual>"
    root = "world" if "world" in links else "base"
    robot = load_robot(
        f"<robot name='r'>{links.format(mass=mass, shape=shape)}<joint name='j' "
        f"type='fixed'><parent link='{root}'/><child link='arm'/></joint></robot>"
    )
    session = show(robot=robot, fixed=root)
    found = facts(session)
    assert found["Stands On"].startswith(expected[0])
    assert found["Tips Over At"].startswith(expected[1])
    session.display_edits.set_property(model_of(session), BALANCE, True)
    assert model_of(session).status.rows["Balance"].level == "Ok"


def test_links_of_sdf_that_do_not_say_their_mass_are_named(show: Show) -> None:
    weight = "<inertial><pose>0.01234567 0 0 0 0 0</pose><mass>3</mass></inertial>"
    joints = "".join(
        f"<joint name='{end}_joint' type='fixed'><parent>base</parent>"
        f"<child>{end}</child></joint>"
        for end in ("mast", "lamp")
    )
    text = (
        f"<sdf version='1.9'><model name='r'><link name='base'>{weight}</link>"
        f"<link name='mast'/><link name='lamp'/>{joints}</model></sdf>"
    )
    found = facts(show(robot=load_robot(text), fixed="base"))
    assert found["Total Mass"] == (
        "5 kg, with SDF's 1 kg each for mast, lamp without <inertial>"
    )
    assert found["Center of Mass"] == "0.0074; 0; 0 m in base"


def test_a_robot_without_masses_says_so(show: Show, nodes: Nodes) -> None:
    robot = load_robot(
        "<robot name='r'><link name='base'><visual><geometry><sphere radius='1'/>"
        "</geometry></visual></link></robot>"
    )
    session = show("      Mass Properties: {Balance: true}", robot=robot)
    assert facts(session) == {"Total Mass": "unknown: no link has a mass"}
    assert marks(session, nodes) == {}
    assert model_of(session).status.rows["Balance"] == Status(
        "Warn", "No link of this robot has a mass"
    )
