"""LaserScan and PointCloud2 draw what a recording has at the time of its player."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest
from inside import session_of

from sambot_viz import Visualizer
from sambot_viz.displays.data.cloud.cloud_display import CloudDisplay
from sambot_viz.displays.data.cloud.laser_scan import moved_points
from sambot_viz.displays.display import Display
from sambot_viz.frames import Transform

MESSAGES = Path(__file__).parents[2] / "golden" / "messages"
Open = Callable[[str], Visualizer]


@pytest.fixture
def opened() -> Iterator[Open]:
    """Opens a recorded case at its end."""
    with ExitStack() as stack:

        def open_case(name: str) -> Visualizer:
            folder = MESSAGES / name
            source = f"bag:{folder / 'messages.mcap'}"
            config = folder / "config.rviz"
            viz = stack.enter_context(Visualizer(source=source, config=config, port=0))
            viz.player.jump(viz.player.duration)
            return viz

        yield open_case


def display(viz: Visualizer) -> CloudDisplay:
    displays: list[Display] = session_of(viz).scene.displays
    return next(one for one in displays if isinstance(one, CloudDisplay))


def statuses(viz: Visualizer) -> dict[str, str]:
    return {key: row.text for key, row in display(viz).status.rows.items()}


def test_a_scan_says_what_rviz_says(opened: Open) -> None:
    viz = opened("scan_points_rainbow")
    assert statuses(viz) == {
        "Topic": "1 messages received at 0.0 hz.",
        "Points": "Showing [19] points from [1] messages",
        "Transform": "Transform OK",
    }


def test_readings_outside_of_the_range_are_not_drawn(opened: Open) -> None:
    assert "Showing [9] points" in statuses(opened("scan_inf_nan_limits"))["Points"]


def test_scans_stay_for_their_decay_time_each_in_its_place(opened: Open) -> None:
    viz = opened("scan_decay_three")
    assert "from [3] messages" in statuses(viz)["Points"]
    session = session_of(viz)
    with session.lock:
        session.display_edits.set_property(display(viz), "Decay Time", 0.0)
    viz.player.jump(viz.player.duration)
    assert "from [1] messages" in statuses(viz)["Points"]


def test_a_display_that_is_off_asks_for_nothing(opened: Open) -> None:
    viz = opened("cloud_intensity_points")
    session, shown = session_of(viz), display(viz)
    assert shown.subscription is not None
    session.display_edits.set_enabled(shown.config, False)
    assert shown.subscription is None
    assert not shown.status.rows
    session.display_edits.set_enabled(shown.config, True)
    assert "Showing [" in statuses(viz)["Points"]


def test_a_wrong_topic_says_which_one_was_meant(opened: Open) -> None:
    viz = opened("scan_points_rainbow")
    session = session_of(viz)
    session.display_edits.set_property(display(viz), "Topic", "/scn")
    assert "Topic" in display(viz).repairs()
    assert display(viz).repairs()["Topic"].value == "/scan"
    assert "Points" not in statuses(viz)
    session.display_edits.set_property(display(viz), "Topic", "/tf_static")
    assert "this is tf2_msgs/msg/TFMessage" in statuses(viz)["Topic"]


def test_another_fixed_frame_places_the_same_points_again(opened: Open) -> None:
    viz = opened("scan_squares_flatcolor")
    session = session_of(viz)
    assert statuses(viz)["Transform"] == "Transform OK"
    session.document.set_option("Fixed Frame", "nowhere")
    assert "Points" not in statuses(viz)
    session.document.set_option("Fixed Frame", "map")
    assert "Showing [19] points" in statuses(viz)["Points"]


def test_a_scanner_that_moves_measures_each_point_where_it_was() -> None:
    points = np.array([(1.0, 0.0, 0.0)] * 3)
    ratio = np.array([0.0, 0.5, 1.0])
    quarter = Transform.from_xyz_rpy((2.0, 0.0, 0.0), (0.0, 0.0, np.pi / 2))
    found = moved_points(points, ratio, Transform.identity(), quarter)
    half = np.sqrt(0.5)
    wanted = [(1.0, 0.0, 0.0), (1.0 + half, half, 0.0), (2.0, 1.0, 0.0)]
    assert np.allclose(found, wanted)


def test_points_without_the_channel_say_which_they_have(opened: Open) -> None:
    shown = display(opened("scan_points_rainbow"))
    shown.config.set("Color Transformer", "Intensity")
    shown.config.set("Channel Name", "foo")
    assert shown.notes()["Channel Name"] == (
        "The points have no foo, so all are white; they have intensity, x, y and z"
    )


def test_a_new_display_has_the_transformers_that_rviz_would_choose(
    opened: Open,
) -> None:
    viz = opened("scan_points_rainbow")
    session, text = session_of(viz), session_of(viz).document.config.to_yaml()
    topic = {"Topic": "/scan"}
    kind = "rviz_default_plugins/LaserScan"
    session.display_edits.add_display(kind, values=topic)
    viz.player.jump(viz.player.duration)
    new = session.scene.displays[-1]
    assert new.config.get("Position Transformer") == "XYZ"
    assert new.config.get("Color Transformer") == "Intensity"
    assert "From " in new.notes()["Autocompute Intensity Bounds"]
    session.display_edits.set_property(new, "Color Transformer", "AxisColor")
    assert new.notes()["Autocompute Value Bounds"].endswith(" m")
    session.display_edits.set_property(new, "Color Transformer", "FlatColor")
    assert new.notes() == {}
    # What was chosen for a user is nothing to save.
    session.display_edits.remove_display(new.config)
    assert session.document.config.to_yaml() == text


def test_rows_that_have_no_effect_are_hidden_with_those_they_depend_on(
    opened: Open,
) -> None:
    config = display(opened("scan_points_rainbow")).config
    config.set("Color Transformer", "Intensity")
    assert config.is_shown("Invert Rainbow")
    assert not config.is_shown("Min Color")
    config.set("Use rainbow", False)
    assert config.is_shown("Max Color")
    assert not config.is_shown("Invert Rainbow")
    config.set("Autocompute Intensity Bounds", False)
    assert config.is_shown("Min Intensity")
    config.set("Color Transformer", "FlatColor")
    assert not any(map(config.is_shown, ("Max Color", "Min Intensity", "Use rainbow")))
