"""The Frames panel of one browser."""

from __future__ import annotations

from pathlib import Path

import pytest
from lower_limit import lower
from panel_rows import edit, panel_of, rows_of

from sambot_viz import FrameError, Visualizer, load_robot
from sambot_viz.errors import UsageError
from sambot_viz.frames import Transform
from sambot_viz.frames.static_transform import StaticTransformError
from sambot_viz.panels.frames import frames_panel
from sambot_viz.panels.frames.frames_panel import FramesPanel, pasted_arguments
from sambot_viz.panels.rows.row import Level
from sambot_viz.session import Session

LEFT = "drivewhl_l_link"
FLOATS = """<robot name="floats">
  <link name="ground"/><link name="drone"/>
  <joint name="flies" type="floating">
    <parent link="ground"/><child link="drone"/>
  </joint>
</robot>"""
LASER = (0.1, 0, 0.2, 0, 0, 0.5, "base_link", "base_laser")


@pytest.fixture
def said() -> list[tuple[str, Level]]:
    return []


@pytest.fixture
def panel(session: Session, said: list[tuple[str, Level]]) -> FramesPanel:
    return panel_of(FramesPanel, session, say=lambda *what: said.append(what))


def values(panel: FramesPanel) -> dict[str, object]:
    return {row_id: row.value for row_id, row in rows_of(panel).items()}


def ask(panel: FramesPanel, source: str, target: str) -> None:
    edit(panel, "frames/from", source)
    edit(panel, "frames/to", target)


def test_where_the_wheel_is_in_the_body(panel: FramesPanel, viz: Visualizer) -> None:
    ask(panel, "base_link", LEFT)
    found = values(panel)
    x, y, z = (float(part) for part in str(found["frames/xyz"]).split())
    expected = viz.frames.lookup("base_link", LEFT).translation.tolist()
    assert [x, y, z] == pytest.approx(expected, abs=1e-6)
    length = sum(part * part for part in expected) ** 0.5
    assert float(str(found["frames/distance"])) == pytest.approx(length, abs=1e-6)
    assert len(str(found["frames/xyzw"]).split()) == 4
    assert len(str(found["frames/matrix/rows"]).splitlines()) == 4


def test_the_texts_to_copy_are_read_back_as_the_same_pose(
    panel: FramesPanel, viz: Visualizer
) -> None:
    edit(panel, "frames/add", [*LASER])
    ask(panel, "base_link", "base_laser")
    found = values(panel)
    assert found["frames/copy/eight"] == "0.1 0 0.2 0.5 0 0 base_link base_laser"
    assert found["frames/copy/flags"] == (
        "--x 0.1 --y 0 --z 0.2 --roll 0 --pitch 0 --yaw 0.5 "
        "--frame-id base_link --child-frame-id base_laser"
    )
    assert found["frames/copy/urdf"] == '<origin xyz="0.1 0 0.2" rpy="0 0 0.5"/>'
    before = viz.frames.lookup("base_link", "base_laser")
    for key in ("launch", "flags", "eight"):
        edit(panel, "frames/remove", ["static/base_laser"])
        edit(panel, "frames/paste", [found[f"frames/copy/{key}"]])
        assert viz.frames.lookup("base_link", "base_laser") == before


def test_the_way_is_shown_step_by_step(panel: FramesPanel) -> None:
    ask(panel, "drivewhl_r_link", LEFT)
    rows = rows_of(panel)
    assert rows["frames/chain"].name.endswith("2 steps")
    assert not rows["frames/chain"].expanded
    assert f"{LEFT} is a child of base_link" in rows["frames/chain/0"].value
    assert "xyz " in rows["frames/chain/1"].value


def test_a_frame_that_does_not_exist_is_explained(panel: FramesPanel) -> None:
    ask(panel, "base_link", "nowhere")
    rows = rows_of(panel)
    assert "'nowhere'" in rows["frames/why"].value
    assert rows["frames/why"].level == "error"
    assert "tf2 says" in rows["frames/tf2"].value
    assert "frames/xyz" not in rows


def test_values_follow_motions_while_the_panel_is_on_the_screen(
    panel: FramesPanel, viz: Visualizer
) -> None:
    ask(panel, "base_link", LEFT)
    assert panel.values() == {}
    edit(panel, "frames/show", [True])
    before = panel.values()["frames/rpy"]
    viz.set_joint_positions({"drivewhl_l_joint": 1.0})
    assert panel.values()["frames/rpy"] != before
    assert set(panel.values()) <= set(rows_of(panel))
    edit(panel, "frames/show", [False])
    assert panel.values() == {}


def test_two_browsers_ask_for_different_frames(
    session: Session, panel: FramesPanel
) -> None:
    other = panel_of(FramesPanel, session)
    ask(panel, "base_link", LEFT)
    assert rows_of(other)["frames/to"].value != "base_link"
    ask(other, LEFT, "base_link")
    assert rows_of(panel)["frames/to"].value == LEFT


def test_a_laser_is_hung_up_moved_and_removed(
    panel: FramesPanel, viz: Visualizer, said: list[tuple[str, Level]]
) -> None:
    edit(panel, "frames/add", [*LASER])
    assert said == [("Added base_laser (parent base_link)", "ok")]
    assert rows_of(panel)["static/base_laser"].value == "in base_link"
    edit(panel, "static/base_laser/xyz", [0.3, 0.0, 0.2])
    edit(panel, "static/base_laser/rpy", [0.0, 0.0, 1.0])
    pose = viz.frames.lookup("base_link", "base_laser")
    assert pose.translation.tolist() == pytest.approx([0.3, 0.0, 0.2])
    assert pose.rpy == pytest.approx((0.0, 0.0, 1.0))
    edit(panel, "frames/remove", ["static/base_laser"])
    assert "base_laser" not in viz.frames
    assert "frames/none" in rows_of(panel)


def test_there_is_room_for_as_many_frames_as_browsers_can_show(
    panel: FramesPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    lower(monkeypatch, "SESSION_FRAMES", 2)
    for child in ("a", "b", "b"):
        edit(panel, "frames/add", [*LASER[:-1], child])
    with pytest.raises(UsageError, match="2 added frames; remove one first"):
        edit(panel, "frames/add", [*LASER[:-1], "c"])


@pytest.mark.parametrize(
    ("parent", "child", "reason"),
    [
        ("", "laser", "name the parent frame"),
        ("base_link", " ", "name the child frame"),
        ("base_lnk", "laser", "did you mean 'base_link'"),
        ("base_link", "base_link", "its own parent"),
        (LEFT, "base_link", "ring"),
        ("base_link", LEFT, "joint 'drivewhl_l_joint' already holds"),
        ("base_link", f"/{LEFT}", "one parent"),
    ],
)
def test_a_wrong_entry_is_refused_with_the_reason(
    panel: FramesPanel, viz: Visualizer, parent: str, child: str, reason: str
) -> None:
    before = set(viz.frames.frames)
    with pytest.raises((UsageError, FrameError), match=reason):
        edit(panel, "frames/add", [0, 0, 0, 0, 0, 0, parent, child])
    assert set(viz.frames.frames) == before


def test_a_frame_that_drive_moves_has_its_parent(
    panel: FramesPanel, session: Session
) -> None:
    session.frames.add("odom", "base_link", Transform.identity(), static=False)
    with pytest.raises(UsageError, match="Drive already holds 'base_link' in 'odom'"):
        edit(panel, "frames/add", [0, 0, 0, 0, 0, 0, "map", "base_link"])


def test_a_floating_joint_leaves_its_child_to_others(
    panel: FramesPanel, viz: Visualizer, session: Session, tmp_path: Path
) -> None:
    model = tmp_path / "floats.urdf"
    model.write_text(FLOATS, "utf-8")
    session.show_robot(load_robot(model))
    edit(panel, "frames/add", [1, 0, 0, 0, 0, 0, "ground", "drone"])
    assert viz.frames.lookup("ground", "drone").translation.tolist() == [1, 0, 0]


def test_a_wrong_paste_is_refused_as_the_tool_itself_does(panel: FramesPanel) -> None:
    with pytest.raises(StaticTransformError, match="Extra unparsed"):
        edit(panel, "frames/paste", ["1 2 3 base_link laser"])


@pytest.mark.parametrize(
    "pasted",
    [
        "0.1 0 0.2 0 0 0 base_link laser",
        "ros2 run tf2_ros static_transform_publisher 0.1 0 0.2 0 0 0 base_link laser",
        "static_transform_publisher 0.1 0 0.2 0 0 0 base_link laser --ros-args -p a:=1",
        "arguments=['0.1', '0', '0.2', '0', '0', '0', 'base_link', 'laser']",
    ],
)
def test_a_command_or_a_line_of_a_launch_file_may_be_pasted(
    panel: FramesPanel, viz: Visualizer, pasted: str
) -> None:
    edit(panel, "frames/paste", [pasted])
    pose = viz.frames.lookup("base_link", "laser")
    assert pose.translation.tolist() == pytest.approx([0.1, 0.0, 0.2])


def test_arguments_alone_stay_as_they_are() -> None:
    assert pasted_arguments("--x 1 --frame-id a") == "--x 1 --frame-id a"


def test_all_frames_are_a_tree_once_a_page_asks(
    panel: FramesPanel, viz: Visualizer
) -> None:
    assert {row.id: row for row in panel.rows()}[frames_panel.ALL].extra == {
        "lazy": True
    }
    edit(panel, "frames/unfold", [frames_panel.ALL])
    parents = {row.name: row.parent for row in panel.rows() if row.icon == "frame"}
    assert set(parents) == set(viz.frames.frames)
    assert parents["base_link"] == frames_panel.ALL
    assert parents[LEFT] == "frame/base_link"
