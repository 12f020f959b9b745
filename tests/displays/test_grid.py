"""Grid: its lines, its limits, and when it is sent."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import viser

from sambot_viz import limits
from sambot_viz.displays.grid import (
    drawn_cells,
    grid_segments,
    line_count,
)
from sambot_viz.frames import Transform
from sambot_viz.session import Session

Show = Callable[..., Session]
Nodes = Callable[[Session], dict[str, viser.SceneNodeHandle]]


def test_the_default_grid_has_22_lines_of_ten_metres() -> None:
    segments = grid_segments(10, 0, 1.0)
    assert segments.shape == (22, 2, 3)
    lengths = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    assert np.allclose(lengths, 10.0)
    assert np.allclose(segments[:, :, 1], 0.0)


def test_a_grid_of_two_cells_of_two_metres_reaches_two_metres() -> None:
    points = grid_segments(2, 0, 2.0).reshape(-1, 3)
    assert points.min(axis=0) == pytest.approx([-2, 0, -2])
    assert points.max(axis=0) == pytest.approx([2, 0, 2])


def test_layers_are_centred_on_the_plane() -> None:
    points = grid_segments(3, 4, 1.5).reshape(-1, 3)
    assert points.min(axis=0) == pytest.approx([-2.25, -3, -2.25])
    assert points.max(axis=0) == pytest.approx([2.25, 3, 2.25])
    one_cell_high = grid_segments(4, 1, 1.0)
    assert set(np.unique(one_cell_high[:, 0, 1])) == {-0.5, 0.5}


def test_the_number_of_lines_follows_the_formula() -> None:
    for cells, layers in ((1, 0), (4, 2), (3, 1)):
        uprights = (cells + 1) ** 2 if layers else 0
        expected = 2 * (cells + 1) * (layers + 1) + uprights
        assert len(grid_segments(cells, layers, 0.5)) == expected


GRID = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Floor
{body}
    - {{Class: rviz_default_plugins/Axes, Enabled: true, Name: Axes}}
  Global Options: {{Fixed Frame: base}}
"""


@pytest.fixture
def grid(show: Show) -> Show:
    """``grid("      Alpha: 1")``: a session with a Grid and an Axes display."""

    def open_session(body: str = "", **more: Any) -> Session:
        return show(config=GRID.format(body=body), **more)

    return open_session


@pytest.mark.parametrize("cells", [10**6, 2**31 - 1])
@pytest.mark.parametrize("layers", [0, 3, 2**31 - 1])
def test_a_grid_of_far_too_many_cells_is_drawn_with_fewer(
    cells: int, layers: int
) -> None:
    drawn = drawn_cells(cells, layers)
    assert (
        len(grid_segments(*drawn, 1.0)) == line_count(*drawn) <= limits.GRID_LINES.value
    )
    assert drawn[0] >= 20


def test_a_grid_that_can_be_drawn_is_drawn_as_it_is() -> None:
    assert drawn_cells(1000, 0) == (1000, 0)
    assert drawn_cells(100, 100) == (100, 100)


def test_the_status_reports_fewer_cells_and_the_file_keeps_its_count(
    grid: Show,
) -> None:
    session = grid("      Plane Cell Count: 1000000000")
    status = session.scene.displays[0].status.rows["Cells"]
    assert status.level == "Warn"
    assert "(2,000,000,002 lines; the limit is 100,000)" in status.text
    assert "Plane Cell Count: 1000000000" in session.document.config.to_yaml()
    session.display_edits.set_property(
        session.scene.displays[0], "Plane Cell Count", 10
    )
    assert set(session.scene.displays[0].status.rows) == {"Transform"}
    session.display_edits.set_property(
        session.scene.displays[0], "Plane Cell Count", 2**31 - 1
    )
    assert session.scene.displays[0].config.get("Plane Cell Count") == 2**31 - 1
    assert "Cells" in session.scene.displays[0].status.rows


def test_a_grid_and_axes_that_have_not_changed_are_not_sent_again(
    grid: Show, nodes: Nodes
) -> None:
    session = grid()
    before = nodes(session)
    session.scene.refresh()
    session.frames.add("base", "laser", Transform.identity())
    session.document.set_option("Background Color", (255, 255, 255))
    after = nodes(session)
    assert len(before) > 1
    assert all(after[name] is handle for name, handle in before.items())
    session.display_edits.set_property(session.scene.displays[0], "Alpha", 0.25)
    changed = nodes(session)
    assert [n for n in before if changed[n] is not before[n]] == [
        name for name in before if name.endswith(session.scene.displays[0].key)
    ]


def test_a_grid_in_an_unknown_frame_is_not_drawn_and_says_so(
    grid: Show, nodes: Nodes
) -> None:
    session = grid("      Reference Frame: nowhere")
    display = session.scene.displays[0]
    status = display.status.rows["Transform"]
    assert status.text == "Could not transform from [nowhere] to [base]"
    assert not any(name.endswith(display.key) for name in nodes(session))
    session.display_edits.set_property(display, "Reference Frame", "upper")
    assert display.status.rows["Transform"].text == "Ok"
    assert any(name.endswith(display.key) for name in nodes(session))
