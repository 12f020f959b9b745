"""Whatever a message says, it harms neither the page nor the messages after it."""

from __future__ import annotations

from collections.abc import Iterator
from unittest import mock

import pytest
from hostile_recording import MESSAGES, STEP_S, Tried, all_tried, write_hostile
from inside import session_of, viser_server
from sent_numbers import bad_numbers
from visible_steps import steps_to

from sambot_viz import Visualizer, limits
from sambot_viz.displays.display import Display
from sambot_viz.panels import row_sync

MOST_ROWS = 110


@pytest.fixture(scope="module")
def attacked(
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[tuple[Visualizer, list[str]]]:
    """All displays after their messages, and the numbers that no browser can draw."""
    source, config = write_hostile(tmp_path_factory.mktemp("bad"), list(all_tried()))
    with (
        # No page is there for which rows of panels are to be made at each step.
        mock.patch.object(row_sync, "PERIOD", 3600.0),
        Visualizer(source=f"bag:{source}", config=config, port=0) as viz,
        bad_numbers(viser_server(viz)) as bad,
    ):
        session = session_of(viz)
        pictures = session.scene.context.pictures
        with session.lock:
            for display in session.scene.displays:
                if display.key in pictures:
                    pictures.want(display.key)
        for _ in steps_to(viz, MESSAGES * STEP_S, STEP_S):
            pass
        yield viz, bad


def display_of(viz: Visualizer, tried: Tried) -> Display:
    displays = session_of(viz).scene.displays
    return next(one for one in displays if one.config.name == tried.topic)


def nodes_of(viz: Visualizer, tried: Tried) -> list[str]:
    keys = {one.key for one in session_of(viz).scene.displays}
    # viser has no public list of a scene's nodes.
    names = viz.viser.scene._handle_from_node_name  # pyright: ignore[reportPrivateUsage]
    wanted = display_of(viz, tried).key
    last = (name.rpartition("/")[2] for name in names if "ambient" not in name)
    return [
        name
        for name in last
        if max(filter(name.startswith, keys), key=len, default="") == wanted
    ]


def test_no_number_is_sent_that_a_browser_cannot_draw(
    attacked: tuple[Visualizer, list[str]],
) -> None:
    assert attacked[1] == []


def test_no_display_raises_an_exception(
    attacked: tuple[Visualizer, list[str]],
) -> None:
    problems = session_of(attacked[0]).problems.shown.value.listed
    assert [one for one in problems if one.code == "internal-error"] == []


@pytest.mark.parametrize(
    "tried", [one for one in all_tried() if one.is_attacked], ids=lambda one: one.topic
)
def test_a_good_message_is_drawn_after_hostile_ones(
    tried: Tried, attacked: tuple[Visualizer, list[str]]
) -> None:
    viz, _ = attacked
    fine = Tried(tried.kind, tried.type_name, tried.number, is_attacked=False)
    rows, others = (display_of(viz, one).status.rows for one in (tried, fine))
    assert len(rows) <= MOST_ROWS
    assert all(len(key) <= limits.KEY.value for key in rows)
    assert all(len(row.text) <= limits.STATUS_TEXT.value for row in rows.values())
    levels = ("Ok", "Warn", "Error")
    worse = [
        key
        for key, row in others.items()
        if levels.index(rows[key].level) > levels.index(row.level)
    ]
    assert worse == []
    drawn, of_fine_drawn = nodes_of(viz, tried), nodes_of(viz, fine)
    assert len(drawn) >= len(of_fine_drawn)
