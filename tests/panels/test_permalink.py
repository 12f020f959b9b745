"""Links: what one browser shows, shown in another one, or not, and why."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from inside import session_of
from panel_rows import data_of, edit, panel_of

from sambot_viz import UsageError, Visualizer
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.panels.joints.joints_panel import JointsPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.permalink.permalink import PermalinkPanel
from sambot_viz.panels.rows.row import Answer
from sambot_viz.panels.sources.source_panel import SourcePanel
from sambot_viz.panels.views import ViewsPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"
Pairs = list[list[str]]
Join = Callable[[], Client]
ORBIT = [["view", "Orbit"], ["view.Distance", "3"]]
END = [["v", "1"]]


class Links:
    """The links of one browser: what it copies, and what it is told."""

    def __init__(self, session: Session, client: Client, joints: bool = True) -> None:
        self.session, self.client = session, client
        panels: list[Panel] = [panel_of(JointsPanel, session)] if joints else []
        if session.data is not None:
            panels.append(SourcePanel(session.sources))
        self.panel = panel_of(
            PermalinkPanel,
            session,
            client,
            views=panel_of(ViewsPanel, session, client),
            row=lambda row_id: next(
                (r for panel in panels for r in panel.rows() if r.id == row_id), None
            ),
        )

    def act(self, command_id: str, *sent: Any) -> Any:
        with self.session.history.acting(self.client.client_id):
            return edit(self.panel, command_id, list(sent))

    def copy(self) -> Pairs:
        self.act("permalink/copy")
        parts: Pairs = data_of(self.panel)["permalink/made"]["parts"]
        return parts

    def open(self, parts: Pairs) -> str:
        answer = self.act(
            "permalink/open", [name for name, _ in parts], [value for _, value in parts]
        )
        assert isinstance(answer, Answer)
        return answer.say


@pytest.fixture
def links(session: Session, client: Client) -> Links:
    return Links(session, client)


def state(links: Links) -> dict[str, Any]:
    session, view = links.session, links.client.view
    assert session.robot.joints is not None
    return {
        "joints": dict(session.robot.joints.positions),
        "kind": view.view.kind,
        "view": dict(view.values),
        "switches": {name: switch.on for name, switch in session.toggles.all().items()},
        "selection": list(links.client.tools.selection),
        "fixed": session.scene.context.fixed_frame,
    }


def change(links: Links) -> None:
    """Move, turn, switch and select something."""
    session, client = links.session, links.client
    session.document.set_option("Fixed Frame", "base_footprint")
    session.robot.set_positions({LEFT: 1.25})
    client.view.set_kind("rviz_default_plugins/XYOrbit")
    client.view.set("Distance", 2.5)
    client.view.set("Focal Point", (0.5, -0.25, 0.0))
    wanted = {
        "Grid/Enabled": False,
        "TF/Show Names": False,
        "RobotModel/Links/=base_link": False,
    }
    for name, on in wanted.items():
        session.toggles.all()[name].set(on)
    client.tools.select(
        {Selectable("link", "base_link"), Selectable("frame", "front_caster")}, None
    )


def test_at_the_start_a_link_is_only_the_view(links: Links) -> None:
    names = [name for name, _ in links.copy()]
    assert names[0] == "view" and names[-1] == "v"
    rest = [name for name in names if not name.startswith("view")]
    assert rest == ["robot", "v"]


def test_a_link_has_what_differs_from_the_start(links: Links) -> None:
    change(links)
    parts = dict(links.copy())
    assert parts["view"] == "XYOrbit"
    assert parts["view.Distance"] == "2.5"
    assert parts["view.Focal Point"] == "0.5,-0.25,0"
    assert parts[f"j.{LEFT}"] == "1.25"
    shown = {name: value for name, value in parts.items() if name.startswith("show.")}
    assert shown == {
        "show.Grid/Enabled": "0",
        "show.TF/Show Names": "0",
        "show.RobotModel/Links/=base_link": "0",
    }
    assert f"j.{RIGHT}" not in parts
    assert parts["fixed"] == "base_footprint"


def test_a_link_shows_the_same_in_another_program(
    links: Links, protocol: Callable[..., Any]
) -> None:
    change(links)
    parts, wanted = links.copy(), state(links)
    with Visualizer(port=0) as other:
        peer = protocol(other.viser.get_port())
        peer.settle(other.viser)
        session = session_of(other)
        peer.wait_until(lambda: bool(session.clients.all))
        (client,) = session.clients.all.values()
        there = Links(session, client)
        session.robot.set_positions({RIGHT: 0.5})
        assert there.open(parts) == "Opened the link"
        assert state(there) == wanted


def test_a_link_brings_its_own_program_back_and_is_one_step_to_undo(
    links: Links,
) -> None:
    change(links)
    parts, wanted = links.copy(), state(links)
    session = links.session
    session.robot.center()
    session.robot.set_positions({RIGHT: 1.0})
    session.toggles.all()["Grid/Enabled"].set(True)
    session.toggles.all()["TF/Show Arrows"].set(False)
    links.client.tools.select(set(), None)
    before = state(links)
    assert links.open(parts) == "Opened the link"
    assert state(links) == wanted
    session.history.undo(links.client.client_id)
    kept = ("joints", "switches")
    assert {k: state(links)[k] for k in kept} == {k: before[k] for k in kept}


@pytest.mark.parametrize(
    ("parts", "said"),
    [
        ([], "this link is incomplete and was not opened: copy it again"),
        ([*ORBIT, [f"j.{LEFT}", "1"]], "this link is incomplete"),
        ([*ORBIT, [f"j.{LEFT}", "1"], ["v", "2"]], "by another version of sambot-viz"),
    ],
)
def test_a_link_that_was_cut_changes_nothing(
    links: Links, parts: Pairs, said: str
) -> None:
    before = state(links)
    with pytest.raises(UsageError, match=said):
        links.open(parts)
    assert state(links) == before


def test_a_link_without_a_view_leaves_the_view(links: Links) -> None:
    links.client.view.set("Distance", 2.5)
    before = state(links)
    assert links.open([[f"j.{LEFT}", "0.5"], *END]) == "Opened the link"
    joints = {**before["joints"], LEFT: 0.5}
    assert state(links) == {**before, "joints": joints}


def test_values_that_cannot_be_are_named_and_the_rest_is_shown(links: Links) -> None:
    said = links.open(
        [
            *ORBIT,
            ["view.Yaw", "much"],
            ["view.Focal Point", "1,2"],
            ["view.Target Frame", "nowhere"],
            ["view.Colour", "red"],
            [f"j.{LEFT}", "nan"],
            [f"j.{RIGHT}", "0.5"],
            ["show.Grid/Enabled", "maybe"],
            ["__proto__", "<img onerror=alert(1)>"],
            *END,
        ]
    )
    assert links.client.view.values["Distance"] == 3.0
    assert state(links)["joints"] == {LEFT: 0.0, RIGHT: 0.5}
    assert "no frame 'nowhere'" in said
    assert "no property of the view 'Colour'" in said
    assert "no part of the link 'show.Grid/Enabled', '__proto__'" in said
    assert "'Yaw' needs a number" in said and "'Focal Point' needs 3 numbers" in said
    assert f"'{LEFT}' needs a number" in said


def test_a_link_of_another_robot_says_what_is_not_here_and_changes_only_what_it_names(
    links: Links,
) -> None:
    links.session.robot.set_positions({LEFT: 1.0})
    links.session.toggles.all()["TF/Show Names"].set(False)
    before = state(links)
    names = [f"joint_{n}" for n in range(6)]
    said = links.open(
        [
            *ORBIT,
            ["robot", "arm"],
            ["fixed", "palm"],
            *([f"j.{name}", "1"] for name in names),
            ["show.Grid/Enabled", "0"],
            ["show.Hand/Enabled", "0"],
            ["select", "link:gripper"],
            ["select", "link:base_link"],
            *END,
        ]
    )
    assert said == (
        "Opened a link of the robot 'arm': no frame 'palm'; "
        "no joint 'joint_0', 'joint_1', 'joint_2', "
        "'joint_3', 2 more; no display or part of one 'Hand/Enabled'; "
        "no link 'gripper'"
    )
    after = state(links)
    assert after["joints"] == before["joints"]
    assert after["switches"] == {**before["switches"], "Grid/Enabled": False}
    assert after["selection"] == [Selectable("link", "base_link")]


def test_a_position_at_a_limit_stays_inside_it(
    tmp_path: Any, protocol: Callable[..., Any]
) -> None:
    model = tmp_path / "arm.urdf"
    model.write_text(
        """<robot name="arm"><link name="a"/><link name="b"/>
        <joint name="elbow" type="revolute"><parent link="a"/><child link="b"/>
        <limit lower="-1.5707963" upper="1.5707963" effort="1" velocity="1"/></joint>
        </robot>""",
        "utf-8",
    )
    with Visualizer(model, port=0) as viz:
        peer = protocol(viz.viser.get_port())
        peer.settle(viz.viser)
        session = session_of(viz)
        peer.wait_until(lambda: bool(session.clients.all))
        (client,) = session.clients.all.values()
        links = Links(session, client)
        session.robot.set_positions({"elbow": 1.5707963})
        parts = links.copy()
        assert ["j.elbow", "1.5707963"] in parts
        session.robot.set_positions({"elbow": 0.1234567})
        assert ["j.elbow", "0.123457"] in links.copy()
        assert links.open(parts) == "Opened the link"
        assert dict(viz.joint_positions) == {"elbow": 1.5707963}


def test_two_displays_of_one_name_are_two_in_a_link(links: Links) -> None:
    session = links.session
    (grid, *_) = session.document.config.displays
    copy = session.display_edits.duplicate_display(grid)
    session.display_edits.rename_display(copy, grid.name)
    session.toggles.all()["Grid*2/Enabled"].set(False)
    parts = links.copy()
    assert ["show.Grid*2/Enabled", "0"] in parts
    session.toggles.all()["Grid*2/Enabled"].set(True)
    assert links.open(parts) == "Opened the link"
    assert grid.enabled and not copy.enabled


def test_who_watches_sees_the_view_of_a_link_and_moves_nothing(
    protocol: Callable[..., Any],
) -> None:
    with Visualizer(port=0, presenter="who-has-this-drives") as viz:
        peer = protocol(viz.viser.get_port())
        peer.settle(viz.viser)
        session = session_of(viz)
        peer.wait_until(lambda: bool(session.clients.all))
        (client,) = session.clients.all.values()
        links = Links(session, client)
        assert all(command.client_local for command in links.panel.commands())
        only_view = [*ORBIT, *END]
        assert links.open(only_view) == "Opened the link"
        before = state(links)
        said = links.open(
            [*ORBIT, [f"j.{LEFT}", "1"], ["select", "link:base_link"], *END]
        )
        assert "joints and displays stay as they are: view only" in said
        after = state(links)
        assert after["selection"] == [Selectable("link", "base_link")]
        assert {**after, "selection": []} == before


def test_a_page_without_the_joints_panel_shows_the_view_and_moves_no_joint(
    session: Session, client: Client
) -> None:
    links = Links(session, client, joints=False)
    session.robot.set_positions({LEFT: 1.0})
    said = links.open([*ORBIT, [f"j.{LEFT}", "0.5"], [f"j.{RIGHT}", "1"], *END])
    assert said.endswith("not all of it: this page has no panel that moves joints")
    assert state(links)["joints"] == {LEFT: 1.0, RIGHT: 0.0}
    assert client.view.values["Distance"] == 3.0


def test_another_config_begins_with_its_own_switches(
    links: Links, session: Session
) -> None:
    config = session.document.config.copy()
    session.toggles.all()["Grid/Enabled"].set(False)
    config.displays[0].set_enabled(False)
    session.document.replace(config)
    assert not [name for name, _ in links.copy() if name.startswith("show.")]


@pytest.fixture
def recorded(protocol: Callable[..., Any], repository: Path) -> Iterator[Links]:
    with Visualizer(repository / "assets" / "square.mcap", port=0) as viz:
        peer = protocol(viz.viser.get_port())
        peer.settle(viz.viser)
        session = session_of(viz)
        peer.wait_until(lambda: bool(session.clients.all))
        (client,) = session.clients.all.values()
        yield Links(session, client)


def test_a_link_stops_a_recording_at_its_time(recorded: Links) -> None:
    data, joints = recorded.session.data, recorded.session.robot.joints
    assert data is not None and data.player is not None and joints is not None
    player = data.player
    player.pause()
    player.jump(player.start_ns + 7_123_456_789)
    positions, parts = dict(joints.positions), recorded.copy()
    assert ["time", "7.123456789"] in parts
    assert not [name for name, _ in parts if name.startswith("j.")]

    player.jump(player.start_ns)
    player.play()
    assert recorded.open(parts) == "Opened the link"
    assert not player.playback.value.playing
    assert player.time_ns - player.start_ns == 7_123_456_789
    assert joints.positions == positions


@pytest.mark.parametrize("time", ["-1", "1e9", "nan", "now"])
def test_a_time_that_the_recording_does_not_have_is_refused(
    recorded: Links, time: str
) -> None:
    data = recorded.session.data
    assert data is not None and data.player is not None
    data.player.pause()
    before = data.player.time_ns
    said = recorded.open([*ORBIT, ["time", time], *END])
    assert "but not all of it: 'Time'" in said
    assert data.player.time_ns == before


def test_joints_that_a_recording_moves_stay_with_it(recorded: Links) -> None:
    said = recorded.open([*ORBIT, [f"j.{LEFT}", "1"], *END])
    assert said.endswith("joints are moved by square.mcap, not by the link")


def test_the_time_of_a_link_needs_a_recording(links: Links) -> None:
    said = links.open([*ORBIT, ["time", "2"], *END])
    assert said.endswith("not all of it: no recording is played here")
