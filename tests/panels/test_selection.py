"""The Selection panel of one browser."""

from __future__ import annotations

from pathlib import Path

import pytest
from panel_rows import edit, panel_of, row_named, rows_of

from sambot_viz import Visualizer, load_robot
from sambot_viz.displays.picking.selectable import Selectable
from sambot_viz.panels.selection.selection import SHOWN, SelectionPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

POST = """<robot name="post">
  <link name="foot">
    <inertial>
      <mass value="2.5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <link name="post"/>
  <joint name="stands" type="fixed"><parent link="foot"/><child link="post"/></joint>
</robot>"""
ROW = """<robot name="row">
  <link name="a"/><link name="b"/><link name="c"/>
  <joint name="ab" type="fixed">
    <parent link="a"/><child link="b"/><origin xyz="0.0012345678 0 0"/>
  </joint>
  <joint name="bc" type="fixed">
    <parent link="b"/><child link="c"/><origin xyz="0.0012345678 0 0"/>
  </joint>
</robot>"""
LEFT = Selectable("link", "drivewhl_l_link")
RIGHT = Selectable("link", "drivewhl_r_link")


@pytest.fixture
def panel(session: Session, client: Client) -> SelectionPanel:
    return panel_of(SelectionPanel, session, client)


def facts(panel: SelectionPanel) -> dict[str, str]:
    return {row.name: row.value for row in panel.rows() if row.kind == "readonly"}


def test_nothing_is_selected_at_first(panel: SelectionPanel) -> None:
    (row,) = panel.rows()
    assert "Choose Select" in row.value


def test_a_link_has_its_facts(panel: SelectionPanel, client: Client) -> None:
    client.tools.select({LEFT}, None)
    found = facts(panel)
    assert found["Position"] == "-0.12; 0.18; -0.05 m"
    assert found["Parent"] == "base_link"
    assert found["Joint"].startswith("drivewhl_l_joint (continuous)")
    assert found["Visual"].startswith("Cylinder of radius 0.1 m")
    assert found["Orientation"].endswith("(xyzw)")
    assert ".xacro:" in found["Defined at"]


def test_a_motion_changes_the_values_only(
    panel: SelectionPanel, client: Client, viz: Visualizer, session: Session
) -> None:
    client.tools.select({LEFT}, None)
    before = rows_of(panel)
    viz.set_joint_positions({"drivewhl_l_joint": 1.0})
    values = panel.values()
    joint = row_named(panel, "Joint position").id
    assert values[joint] == "1 rad, no limits"
    assert values[joint] != before[joint].value
    assert set(values) <= set(before)


def test_poses_are_shown_in_a_chosen_frame(
    panel: SelectionPanel, client: Client
) -> None:
    client.tools.select({LEFT}, None)
    edit(panel, "selection/frame", "drivewhl_l_link")
    assert facts(panel)["Position"] == "0; 0; 0 m"
    edit(panel, "selection/frame", "nowhere")
    assert "nowhere" in facts(panel)["Pose"]


def test_two_items_are_so_far_apart(panel: SelectionPanel, client: Client) -> None:
    client.tools.select({LEFT, RIGHT}, None)
    found = facts(panel)
    assert found["Distance"].startswith("0.36 m, from ")
    assert "along the axes of" in found["Offset"]
    client.tools.select({Selectable("link", "base_link")}, "shift")
    assert "Distance" not in facts(panel)


def test_three_items_come_folded(panel: SelectionPanel, client: Client) -> None:
    client.tools.select({LEFT, RIGHT}, None)
    heads = [row for row in panel.rows() if row.kind == "group"]
    assert [row.expanded for row in heads] == [True, True]
    client.tools.select({Selectable("link", "base_link")}, "shift")
    heads = [row for row in panel.rows() if row.kind == "group"]
    assert heads[0].name == "Distances [m]"
    assert [row.expanded for row in heads[1:]] == [False, False, False]


def test_more_than_two_items_have_a_table_of_distances(
    panel: SelectionPanel, client: Client, viz: Visualizer
) -> None:
    client.tools.select({LEFT, RIGHT}, None)
    client.tools.select({Selectable("link", "base_link")}, "shift")
    before = rows_of(panel)["apart/table"].value
    assert [line.split() for line in before.split("\n")] == [
        ["1", "2", "3"],
        ["1", LEFT.name, "-", "0.36", "0.222"],
        ["2", RIGHT.name, "0.36", "-", "0.222"],
        ["3", "base_link", "0.222", "0.222", "-"],
    ]
    assert panel.values()["apart/table"] == before
    client.tools.select({Selectable("frame", "nowhere")}, "shift")
    assert "?" in rows_of(panel)["apart/table"].value


def test_the_columns_of_the_table_do_not_touch(
    panel: SelectionPanel, client: Client, session: Session, tmp_path: Path
) -> None:
    model = tmp_path / "row.urdf"
    model.write_text(ROW, "utf-8")
    session.show_robot(load_robot(model))
    client.tools.select({Selectable("link", name) for name in "abc"}, None)
    lines = rows_of(panel)["apart/table"].value.split("\n")
    assert len({len(line) for line in lines}) == 1
    assert lines[1].split() == ["1", "a", "-", "0.001235", "0.002469"]
    assert all("  -" in line for line in lines[1:])


def test_a_long_selection_says_how_many_more_there_are(
    panel: SelectionPanel, client: Client
) -> None:
    many = {Selectable("frame", f"f{number}") for number in range(SHOWN + 2)}
    client.tools.select(many, None)
    assert rows_of(panel)["selection/more"].value == "and 2 more"


def test_the_body_has_a_mass_and_children(
    panel: SelectionPanel, client: Client, session: Session, tmp_path: Path
) -> None:
    model = tmp_path / "post.urdf"
    model.write_text(POST, "utf-8")
    session.show_robot(load_robot(model))
    client.tools.select({Selectable("link", "foot")}, None)
    found = facts(panel)
    assert found["Mass"] == "2.5 kg"
    assert found["Children"] == "post"
    assert found["Child joints"] == "stands"
    assert found["Defined at"] == "post.urdf:2"
