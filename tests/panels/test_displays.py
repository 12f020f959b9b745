"""The Displays panel: its rows, and what a browser can do with them."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from inside import session_of
from panel_rows import commands_of, data_of, edit, panel_of, rows_of
from patience import patience

from sambot_viz import SambotVizError, Visualizer
from sambot_viz.frames import Transform
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.panels.displays.display_commands import DisplayCommands
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import ProblemsPanel
from sambot_viz.panels.rows.row import Row
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

ROBOT = """
<robot name="two">
  <link name="base">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><box size="1 1 1"/></geometry></collision>
  </link>
  <link name="arm/tip"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="arm/tip"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
  </joint>
</robot>
"""
CONFIG = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true}
    - {Class: rviz_default_plugins/TF, Name: Frames of it, Enabled: true}
    - Class: rviz_common/Group
      Name: Ground
      Enabled: true
      Displays:
        - {Class: rviz_default_plugins/Grid, Name: Floor, Enabled: true}
    - {Class: my_plugins/Radar, Name: Radar, Enabled: true, Gain: 3}
  Global Options: {Fixed Frame: base}
"""


class Displays:
    """The panel of a session, whose rows are found by the names on the way to them."""

    def __init__(self, session: Session) -> None:
        self.remade: list[Panel] = []
        self.panel = panel_of(DisplaysPanel, session, remake=self.remade.append)
        self.new = panel_of(
            DisplayCommands, session, displays=self.panel, remake=self.remade.append
        )

    def all(self) -> dict[str, Row]:
        """Every row by its id, in the order of the page."""
        return rows_of(self.panel)

    def named(self, *names: str) -> Row:
        """The row at a path of names, such as "Grid", "Cell Size"."""
        found: Row | None = None
        for name in names:
            parent = "" if found is None else found.id
            found = next(
                row
                for row in self.all().values()
                if row.parent == parent and row.name == name
            )
        assert found is not None
        return found

    def below(self, *names: str) -> list[str]:
        """The names of the rows right below a row; of all at the top without names."""
        parent = self.named(*names).id if names else ""
        return [row.name for row in self.all().values() if row.parent == parent]

    def set(self, item_id: str, value: object) -> None:
        """What a browser does to a row, or calls."""
        new = item_id in commands_of(self.new)
        edit(self.new if new else self.panel, item_id, value)

    def change(self, *names: str, to: object) -> None:
        """Set the row at a path of names."""
        self.set(self.named(*names).id, to)

    def unfold(self, *names: str) -> None:
        """Ask for what is below a row."""
        self.set("displays/unfold", [self.named(*names).id])

    def order(self) -> list[str]:
        """The names of the displays, those in groups after the group's name."""
        return [r.name for r in self.all().values() if r.extra and "display" in r.extra]

    def act(self, what: str, name: str, *arguments: object) -> None:
        """Use an action on the display with this name."""
        row = next(row for row in self.all().values() if row.name == name and row.bold)
        self.set(f"displays/{what}", [row.id, *arguments])


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    model, config = tmp_path / "two.urdf", tmp_path / "two.rviz"
    model.write_text(ROBOT)
    config.write_text(CONFIG)
    with Visualizer(model, config, port=0) as viz:
        yield session_of(viz)


@pytest.fixture
def displays(session: Session) -> Displays:
    return Displays(session)


def test_the_tree_is_rvizs(displays: Displays) -> None:
    assert displays.below() == [
        "Global Options",
        "Global Status",
        "Robot",
        "Frames of it",
        "Ground",
        "Radar",
    ]
    assert displays.below("Ground") == ["Floor"]
    assert displays.below("Robot")[:3] == [
        "Status",
        "Visual Enabled",
        "Collision Enabled",
    ]
    assert displays.named("Robot", "Visual Enabled").value is True


# Values


def test_a_value_is_set_and_drawn_from(displays: Displays, session: Session) -> None:
    displays.change("Robot", "Alpha", to=0.5)
    assert session.scene.displays[0].config.get("Alpha") == 0.5
    assert displays.named("Robot", "Alpha").value == 0.5


@pytest.mark.parametrize(
    ("typed", "colour"),
    [
        ("255; 255; 255", (255, 255, 255)),
        ("48;48;48", (48, 48, 48)),
        ("#fff", (255, 255, 255)),
        ("#102030", (16, 32, 48)),
        ("White", (255, 255, 255)),
        ([1, 2, 3], (1, 2, 3)),
    ],
)
def test_a_colour_is_taken_as_people_write_it(
    displays: Displays, session: Session, typed: object, colour: object
) -> None:
    displays.change("Global Options", "Background Color", to=typed)
    assert session.scene.context.background == colour


@pytest.mark.parametrize(
    "typed",
    [
        *("255", "1; 2", "#12345", "whitish", "", [1, 2]),
        *("300; 0; 0", "0;-1;0", "1; 2; 3; 4", "0.5; 0; 0", [256, 0, 0]),
    ],
)
def test_a_wrong_colour_is_refused_with_a_reason(
    displays: Displays, session: Session, typed: object
) -> None:
    with pytest.raises(SambotVizError, match="Background Color"):
        displays.change("Global Options", "Background Color", to=typed)
    assert session.scene.context.background == (48, 48, 48)


def test_a_vector_says_what_its_parts_are_called(displays: Displays) -> None:
    offset = displays.named("Ground", "Floor", "Offset")
    assert offset.kind == "vector"
    assert offset.extra == {"parts": ["X", "Y", "Z"]}


# Statuses


def test_a_status_that_is_fine_only_sends_its_rows_when_it_is_unfolded(
    displays: Displays,
) -> None:
    status = displays.named("Robot", "Status")
    assert (status.value, status.expanded) == ("Ok", False)
    assert displays.below("Robot", "Status") == []
    displays.unfold("Robot", "Status")
    assert displays.remade == [displays.panel]
    assert displays.below("Robot", "Status") == ["URDF", "base", "arm/tip"]


def test_only_rows_that_have_more_below_can_be_asked_for_it(displays: Displays) -> None:
    displays.set("displays/unfold", ["no such row"])
    assert displays.remade == []


def test_a_fixed_frame_that_is_missing_is_taken_and_every_status_says_which_there_are(
    displays: Displays,
) -> None:
    displays.change("Global Options", "Fixed Frame", to="map")
    sentence = "Frame [map] does not exist. There are: arm/tip, base"
    assert displays.named("Global Status").value == "Error"
    assert displays.named("Global Status").expanded
    assert displays.named("Global Status", "Fixed Frame").value == sentence
    for name in ("Robot", "Frames of it"):
        assert displays.named(name, "Status").expanded
        assert displays.named(name, "Status", "Fixed Frame").value == sentence
    assert displays.named("Robot", "Status", "base").level == "error"
    # A button sets the root of what there is.
    for status in (("Global Status",), ("Robot", "Status")):
        assert displays.named(*status, "Fixed Frame").extra == {
            "repair": ["Use base", "options/Fixed Frame", "base"]
        }
    displays.set("options/Fixed Frame", "base")
    assert displays.named("Global Status", "Fixed Frame").value == "OK"
    assert displays.named("Global Status", "Fixed Frame").extra is None


def test_of_many_frames_a_missing_one_names_a_few(
    displays: Displays, session: Session
) -> None:
    for number in range(60):
        session.frames.add("base", f"frame{number:02}", Transform.identity())
    displays.change("Global Options", "Fixed Frame", to="map")
    said = displays.named("Global Status", "Fixed Frame").value
    assert str(said).endswith("There are: arm/tip, base, frame00, frame01 and 58 more")


def test_a_frame_that_is_missing_is_repaired_by_the_nearest_name(
    displays: Displays, session: Session
) -> None:
    displays.change("Global Options", "Fixed Frame", to="arm_tip")
    for status in (("Global Status",), ("Robot", "Status")):
        assert displays.named(*status, "Fixed Frame").extra == {
            "repair": ["Use arm/tip", "options/Fixed Frame", "arm/tip"]
        }
    displays.set("options/Fixed Frame", "base")
    path = ("Ground", "Floor")
    for wrong, right in (("bsae", "base"), ("nowhere", "<Fixed Frame>")):
        displays.change(*path, "Reference Frame", to=wrong)
        row = displays.named(*path, "Reference Frame").id
        status = displays.named(*path, "Status", "Transform")
        assert status.extra == {"repair": [f"Use {right}", row, right]}
        displays.set(row, right)
        assert displays.named(*path, "Status").value == "Ok"


def test_the_page_hears_which_statuses_are_errors(displays: Displays) -> None:
    def errors() -> list[str]:
        return data_of(displays.panel)["displays/errors"]

    assert errors() == []
    floor = displays.named("Ground", "Floor").id
    displays.change("Ground", "Floor", "Reference Frame", to="nowhere")
    assert errors() == [floor]
    # A display that is off has no status.
    displays.change("Ground", "Floor", to=False)
    assert errors() == []
    displays.change("Global Options", "Fixed Frame", to="map")
    assert errors()[0] == displays.named("Global Status").id


def test_bad_rows_of_a_status_come_first(displays: Displays) -> None:
    displays.change("Global Options", "Fixed Frame", to="map")
    levels = [
        row.level
        for row in displays.all().values()
        if row.parent == displays.named("Robot", "Status").id
    ]
    assert levels == sorted(levels, key=["error", "warn", "ok"].index)


def test_while_there_is_no_robot_its_display_names_the_mistakes(tmp_path: Path) -> None:
    model = tmp_path / "two.urdf"
    model.write_text(ROBOT.replace('child link="arm/tip"', 'child link="amr"'))
    inputs = Inputs(Options(model, watch=True), may_be_broken=True)
    with Visualizer.of_inputs(inputs) as viz:
        displays = Displays(session_of(viz))
        status = displays.named("RobotModel", "Status")
        assert (status.value, status.expanded) == ("Error", True)
        mistake = displays.named("RobotModel", "Status", "Model").value
        assert mistake.startswith("two.urdf:")
        assert "'amr'" in mistake
        line = mistake.split(":")[1]
        extra = displays.named("RobotModel", "Status", "Model").extra
        problems = rows_of(
            panel_of(ProblemsPanel, session_of(viz), edits=None, text=None)
        )
        assert extra is not None
        said, panel, row = extra["leads"]
        assert (said, panel) == (f"Show line {line}", "problems")
        assert "'amr'" in problems[row].value
        urdf = displays.named("RobotModel", "Status", "URDF")
        assert urdf.value == "There is no robot to show"


def test_links_without_a_collision_shape_are_named_when_those_are_shown(
    displays: Displays,
) -> None:
    def notes() -> list[str]:
        return [row.value for row in displays.all().values() if row.kind == "note"]

    before = notes()
    displays.change("Robot", "Collision Enabled", to=True)
    assert set(notes()) - set(before) == {"Without a collision shape: arm/tip"}
    displays.change("Robot", "Collision Enabled", to=False)
    assert notes() == before


# Links, joints, frames


def test_links_are_listed_when_they_are_unfolded(displays: Displays) -> None:
    links = displays.named("Robot", "Links")
    assert links.extra == {"lazy": True}
    assert "base" not in displays.below("Robot", "Links")
    displays.unfold("Robot", "Links")
    assert displays.below("Robot", "Links")[-2:] == ["arm/tip", "base"]
    assert displays.below("Robot", "Links", "base") == []
    displays.unfold("Robot", "Links", "base")
    below = displays.below("Robot", "Links", "base")
    assert below[:3] == ["Alpha", "Show Trail", "Show Axes"]
    assert "Position" in below


def test_links_are_unfolded_while_the_displays_change(displays: Displays) -> None:
    links = displays.named("Robot", "Links")
    (unfold,) = displays.panel.commands()
    # The rows of what has changed are made a moment later.
    displays.change("Ground", to=False)
    unfold.run(links.id)
    assert displays.below("Robot", "Links")[-2:] == ["arm/tip", "base"]


def test_the_mass_of_a_robot_is_told_when_it_is_unfolded(displays: Displays) -> None:
    names = ("Robot", "Mass Properties")
    assert displays.below(*names) == ["Mass", "Inertia", "Balance"]
    assert displays.named(*names).extra == {"lazy": True}
    assert list(displays.panel.moved_by) == []
    displays.unfold(*names)
    assert displays.below(*names) == ["Mass", "Inertia", "Balance", "Total Mass"]
    row = displays.named(*names, "Total Mass")
    assert row.value == "unknown: no link has a mass"
    assert row.extra == {"wraps": True}
    assert len(displays.panel.moved_by) == 1


def test_a_link_is_switched_off_alone(displays: Displays, session: Session) -> None:
    displays.unfold("Robot", "Links")
    displays.change("Robot", "Links", "arm/tip", to=False)
    robot = session.scene.displays[0].config
    assert robot.dynamic(("Links", "arm/tip")) == {"Value": "false"}
    assert displays.named("Robot", "Links", "base").value is True
    displays.change("Robot", "Links", "arm/tip", to=True)
    assert displays.named("Robot", "Links", "arm/tip").value is True


def test_a_frame_is_switched_off_alone(displays: Displays, session: Session) -> None:
    displays.unfold("Frames of it", "Frames")
    displays.change("Frames of it", "Frames", "arm/tip", to=False)
    frames = session.scene.displays[1].config.dynamic("Frames")
    assert frames["arm/tip"] == {"Value": "false"}


def test_positions_follow_a_joint(displays: Displays, session: Session) -> None:
    displays.unfold("Robot", "Links")
    displays.unfold("Robot", "Links", "arm/tip")
    shown = displays.named("Robot", "Links", "arm/tip", "Orientation")
    assert displays.panel.values()[shown.id] == "0; 0; 0; 1"
    moved = threading.Event()
    connect([session.robot.positions], moved.set)
    session.robot.set_positions({"turn": 3.0})
    assert moved.wait(patience(10.0))
    assert displays.panel.values()[shown.id] != "0; 0; 0; 1"


# Displays as a whole


def test_a_display_is_added_and_the_page_learns_which_it_is(
    displays: Displays,
) -> None:
    displays.set("displays/add", ["rviz_default_plugins/Axes", "", "mark"])
    assert displays.order()[-1] == "Axes"
    made = data_of(displays.new)["displays/made"]
    assert made == {"row": displays.named("Axes").id, "mark": "mark"}
    displays.set("displays/add", ["rviz_common/Group", " My group ", "mark"])
    assert displays.order()[-1] == "My group"


def test_a_type_that_is_not_known_cannot_be_added(displays: Displays) -> None:
    with pytest.raises(SambotVizError, match="cannot be added"):
        displays.set("displays/add", ["x/Y", "", "mark"])


def test_copies_have_other_names(displays: Displays) -> None:
    for _ in range(2):
        displays.act("duplicate", "Floor", "mark")
    assert displays.below("Ground") == ["Floor", "Floor (3)", "Floor (2)"]


def test_a_display_keeps_its_row_when_it_is_moved(displays: Displays) -> None:
    grid, ground = displays.named("Ground", "Floor").id, displays.named("Ground").id
    displays.act("move", "Floor", "", 0)
    assert displays.order() == ["Floor", "Robot", "Frames of it", "Ground", "Radar"]
    displays.act("move", "Floor", ground, 0)
    assert displays.below("Ground") == ["Floor"]
    assert displays.named("Ground", "Floor").id == grid


def test_a_group_does_not_go_into_itself(displays: Displays) -> None:
    with pytest.raises(SambotVizError, match="into itself"):
        displays.act("move", "Ground", displays.named("Ground").id, 0)


def test_a_display_is_renamed_and_removed(displays: Displays) -> None:
    displays.act("rename", "Robot", "  Wheel axes here ")
    assert displays.order()[0] == "Wheel axes here"
    with pytest.raises(SambotVizError, match="needs a name"):
        displays.act("rename", "Wheel axes here", " ")
    gone = displays.named("Ground").id
    displays.act("remove", "Ground")
    assert displays.order() == ["Wheel axes here", "Frames of it", "Radar"]
    with pytest.raises(SambotVizError, match="no longer exists"):
        displays.set("displays/remove", [gone])


def test_a_display_that_is_not_shown_says_so_and_can_be_arranged(
    displays: Displays, session: Session
) -> None:
    radar = displays.named("Radar")
    assert radar.level == "info"
    (note,) = [row for row in displays.all().values() if row.parent == radar.id]
    assert note.value.startswith("Not shown. A display of ")
    assert note.value.endswith("It stays in the file as it is.")
    displays.change("Radar", to=False)
    displays.act("rename", "Radar", "My radar")
    displays.act("duplicate", "My radar", "mark")
    displays.act("move", "My radar", displays.named("Ground").id, 0)
    assert displays.below("Ground") == ["My radar", "Floor"]
    assert session.document.config.to_yaml().count("Gain: 3") == 2


def test_a_removed_display_comes_back_as_the_same_row(
    displays: Displays, session: Session
) -> None:
    before = displays.named("Robot").id
    with session.history.acting(1):
        displays.act("remove", "Robot")
    session.history.undo(1)
    assert displays.named("Robot").id == before
    assert displays.order()[0] == "Robot"


def test_a_number_makes_only_the_rows_of_its_display_again(displays: Displays) -> None:
    before = displays.all()
    displays.change("Ground", "Floor", "Cell Size", to=2.5)
    after = displays.all()
    assert displays.named("Ground", "Floor", "Cell Size").value == 2.5
    made = {row_id for row_id, row in after.items() if row is not before[row_id]}
    grid = displays.named("Ground", "Floor").id
    of_displays = {row_id for row_id in made if row_id.startswith("d")}
    assert of_displays and all(
        row_id == grid or row_id.startswith(f"{grid}/") for row_id in of_displays
    )
    # A box may change what other displays report.
    displays.change("Ground", "Floor", to=False)
    robot = displays.named("Robot").id
    assert displays.all()[robot] is not after[robot]


def test_rows_that_are_kept_show_what_has_moved_since(
    displays: Displays, session: Session
) -> None:
    path = ("Frames of it", "Frames", "arm/tip")
    for end in (1, 2, 3):
        displays.unfold(*path[:end])
    displays.all()
    before = displays.panel.values()
    session.robot.set_positions({"turn": 1.0})
    moved = displays.panel.values()
    assert moved != before
    displays.change("Ground", "Floor", "Cell Size", to=2.5)
    rows = displays.all()
    assert {row_id: rows[row_id].value for row_id in moved} == moved


def test_a_display_without_a_name_is_called_after_its_class(tmp_path: Path) -> None:
    config = tmp_path / "a.rviz"
    config.write_text(
        "Visualization Manager:\n  Displays:\n"
        "    - {Class: rviz_default_plugins/Grid, Enabled: true}\n"
    )
    with Visualizer(config=config, port=0) as viz:
        panel = panel_of(DisplaysPanel, session_of(viz))
        rows = rows_of(panel).values()
        assert [row.name for row in rows if row.kind == "display"] == ["Grid"]
