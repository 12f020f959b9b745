"""The Views panel of one browser."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from panel_rows import data_of, edit, panel_of, row_named, rows_of

from sambot_viz import bundled, load_config
from sambot_viz.errors import UsageError
from sambot_viz.panels.rows.row import Row
from sambot_viz.panels.views import ViewsPanel
from sambot_viz.session import Session
from sambot_viz.session.clients.client import Client

ORBIT, ABOVE = "Orbit (rviz_default_plugins)", "TopDownOrtho (rviz_default_plugins)"


@pytest.fixture
def panel(session: Session, client: Client) -> ViewsPanel:
    return panel_of(ViewsPanel, session, client)


def test_the_numbers_are_those_of_the_current_view(panel: ViewsPanel) -> None:
    rows = rows_of(panel)
    assert rows["view"].name == "Current View"
    assert rows["view"].value == ORBIT
    assert rows["view/Distance"].parent == "view"
    edit(panel, "view/Distance", 2.5)
    edit(panel, "view/Focal Point", [0.1, 0.0, 0.3])
    rows = rows_of(panel)
    assert rows["view/Distance"].value == 2.5
    assert tuple(rows["view/Focal Point"].value) == (0.1, 0.0, 0.3)


def test_a_number_outside_its_limits_is_refused(panel: ViewsPanel) -> None:
    with pytest.raises(UsageError, match="its limits are"):
        edit(panel, "view/Pitch", 2.0)


def test_another_type_has_its_own_numbers(panel: ViewsPanel) -> None:
    assert rows_of(panel)["view/type"].value == ORBIT
    edit(panel, "view/type", ABOVE)
    rows = rows_of(panel)
    assert rows["view/type"].value == ABOVE
    assert "view/Scale" in rows
    assert "view/Distance" not in rows
    assert data_of(panel)["view/shown"]["kind"] == "TopDownOrtho"


def test_zero_goes_back_to_where_rviz_begins(panel: ViewsPanel, client: Client) -> None:
    edit(panel, "view/Distance", 2.5)
    client.view.zero()
    assert rows_of(panel)["view/Distance"].value == 10.0


def test_a_page_that_comes_back_shows_its_view_which_is_not_an_edit(
    panel: ViewsPanel, session: Session, client: Client
) -> None:
    wanted = {
        "view/Target Frame": "base_link",
        "view/Scale": 120.0,
        "view/X": 0.25,
        "view/Angle": 0.5,
    }
    with session.history.acting(client.client_id):
        edit(panel, "views/restore", [ABOVE, json.dumps(wanted)])
    rows = rows_of(panel)
    assert rows["view/type"].value == ABOVE
    assert {row_id: rows[row_id].value for row_id in wanted} == wanted
    assert session.history.state(client.client_id).value.undo is None


@pytest.mark.parametrize("values", ["", "[1]", "[" * 1000, '{"view/nothing": 1}'])
def test_a_view_that_cannot_be_read_changes_nothing(
    panel: ViewsPanel, values: str
) -> None:
    before = rows_of(panel)
    edit(panel, "views/restore", ["no type", values])
    assert rows_of(panel) == before


def test_a_number_of_a_page_is_checked_as_if_it_were_typed(panel: ViewsPanel) -> None:
    with pytest.raises(UsageError, match="its limits are"):
        edit(panel, "views/restore", [ORBIT, '{"view/Pitch": 2}'])


def test_a_view_is_saved_renamed_used_and_removed(panel: ViewsPanel) -> None:
    edit(panel, "view/Distance", 2.5)
    edit(panel, "views/save", [])
    edit(panel, "views/save", [])
    first, second = (row for row in panel.rows() if row.extra == {"saved": True})
    assert (first.name, second.name) == ("Orbit", "Orbit")
    edit(panel, "views/rename", [first.id, " From the left "])
    assert row_named(panel, "From the left").id == first.id
    edit(panel, "view/Distance", 7.0)
    edit(panel, "views/use", [first.id])
    assert rows_of(panel)["view/Distance"].value == 2.5
    edit(panel, "views/remove", [first.id])
    assert second.id in rows_of(panel)
    with pytest.raises(UsageError, match="no longer exists"):
        edit(panel, "views/use", [first.id])


def test_a_saved_view_needs_a_name(panel: ViewsPanel) -> None:
    edit(panel, "views/save", [])
    with pytest.raises(UsageError, match="needs a name"):
        edit(panel, "views/rename", [row_named(panel, "Orbit").id, "  "])


def test_the_page_is_told_what_its_mouse_has_to_know(panel: ViewsPanel) -> None:
    assert data_of(panel)["view/shown"] == {
        "kind": "Orbit",
        "focalSize": 0.05,
        "focalFixed": True,
    }


def test_an_unknown_type_is_shown_as_orbit_and_says_so(
    session: Session, client: Client, panel: ViewsPanel, tmp_path: Path
) -> None:
    assert "view/:unknown" not in rows_of(panel)
    path = tmp_path / "spiral.rviz"
    text = bundled.config_path().read_text("utf-8")
    path.write_text(text.replace("rviz_default_plugins/Orbit", "a/Spiral"), "utf-8")
    session.document.replace(load_config(path))
    client.view.show()
    rows = rows_of(panel)
    assert "not known here" in rows["view/:unknown"].value
    assert rows["view/type"].value == ORBIT
    edit(panel, "view/type", ABOVE)
    assert "view/:unknown" not in rows_of(panel)


def test_with_follow_the_presenter_the_others_see_what_one_does(
    session: Session,
    client: Client,
    panel: ViewsPanel,
    join: Callable[[], Client],
) -> None:
    other = panel_of(ViewsPanel, session, join())
    edit(panel, "view/Distance", 5.0)
    assert rows_of(other)["view/Distance"].value != 5.0
    edit(other, "view/:lead", True)
    assert rows_of(panel)["view/:lead"].value is True
    edit(panel, "view/Distance", 4.0)
    assert rows_of(other)["view/Distance"].value == 4.0


def test_a_target_frame_that_does_not_exist_is_repaired_by_the_nearest_name(
    panel: ViewsPanel,
) -> None:
    def status() -> Row | None:
        return rows_of(panel).get("view/:target")

    assert status() is None
    for wrong, right in (("base_lnk", "base_link"), ("map", "<Fixed Frame>")):
        edit(panel, "view/Target Frame", wrong)
        said = status()
        assert said is not None
        assert said.value == f"Frame [{wrong}] does not exist"
        assert said.extra == {"repair": [f"Use {right}", "view/Target Frame", right]}
        edit(panel, "view/Target Frame", right)
        assert status() is None


SIDES = {"front": (1, 0), "left": (0, 1), "back": (-1, 0), "right": (0, -1)}


@pytest.mark.parametrize("side", SIDES)
def test_a_side_is_looked_at_without_perspective_and_whole(
    side: str, panel: ViewsPanel, client: Client, session: Session
) -> None:
    edit(panel, "view/type", ABOVE)
    edit(panel, "views/side", [side])
    rows = rows_of(panel)
    assert rows["view/type"].value == ORBIT
    assert rows["view/Orthographic"].value is True
    camera = client.view.camera
    assert -camera.forward == pytest.approx((*SIDES[side], 0), abs=1e-9)
    box = session.picker.robot_box()
    assert box is not None
    # The names of frames need some room at one side.
    middle, size = (box[0] + box[1]) / 2, box[1] - box[0]
    assert abs(camera.look_at - middle).max() < 0.2 * size.max()


@pytest.mark.parametrize("far", [10.0, 100.0, 1e5])
@pytest.mark.parametrize("kind", [ORBIT, ABOVE])
def test_from_however_far_away_a_side_and_a_fit_show_the_robot_at_once(
    kind: str, far: float, panel: ViewsPanel, client: Client
) -> None:
    edit(panel, "views/side", ["front"])
    near = client.view.values["Distance"]
    assert 0.3 < near < 3.0
    edit(panel, "view/type", kind)
    client.view.zero()
    if kind == ORBIT:
        edit(panel, "view/Distance", far)
    edit(panel, "views/side", ["front"])
    assert client.view.values["Distance"] == pytest.approx(near)
    edit(panel, "view/Distance", far)
    client.view.fit()
    # A side has room for the names of frames, too.
    assert near / 2 < client.view.values["Distance"] <= near


def test_the_top_is_rvizs_own_view(panel: ViewsPanel, client: Client) -> None:
    edit(panel, "views/side", ["top"])
    assert rows_of(panel)["view/type"].value == ABOVE
    assert rows_of(panel)["view/Angle"].value == 0.0
    assert rows_of(panel)["view/Scale"].value > 100.0


def test_the_key_of_a_side_looks_from_the_opposite_one_when_it_is_pressed_again(
    panel: ViewsPanel, client: Client
) -> None:
    for seen in ("right", "left", "right"):
        edit(panel, "views/press_side", ["right"])
        assert -client.view.camera.forward[:2] == pytest.approx(SIDES[seen], abs=1e-9)
    # From the menu, the side that is said.
    edit(panel, "views/side", ["right"])
    assert -client.view.camera.forward[:2] == pytest.approx(SIDES["right"], abs=1e-9)


def test_looking_from_a_side_is_one_edit_to_undo(
    panel: ViewsPanel, session: Session, client: Client
) -> None:
    before = {row_id: row.value for row_id, row in rows_of(panel).items()}
    with session.history.acting(client.client_id):
        edit(panel, "views/side", ["front"])
    assert session.history.undo(client.client_id) == "View: front"
    assert {row_id: row.value for row_id, row in rows_of(panel).items()} == before


def test_a_side_that_does_not_exist_is_refused(panel: ViewsPanel) -> None:
    with pytest.raises(UsageError, match="there is no side 'inside'"):
        edit(panel, "views/side", ["inside"])


def test_an_orthographic_view_is_saved_as_an_orbit_that_rviz_can_show(
    panel: ViewsPanel, client: Client, session: Session, tmp_path: Path
) -> None:
    edit(panel, "views/side", ["left"])
    client.view.store()
    path = tmp_path / "side.rviz"
    session.document.save(path)
    view = load_config(path).view
    assert view.kind == "rviz_default_plugins/Orbit"
    assert view.get("Orthographic") is True
    assert view.get("Yaw") == pytest.approx(1.5708, abs=1e-4)
    assert 0.3 < view.get("Distance") < 3.0
    assert load_config(path).problems == ()
