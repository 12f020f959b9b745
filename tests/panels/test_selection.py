"""What is told of a selected link, and the sizes of pictures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from sambot_viz import Visualizer
from sambot_viz.panels.picture import on_background, side
from sambot_viz.panels.selection import apart, facts, geometry_text, item_html
from sambot_viz.robot.model import Box, Cylinder, MeshFile, Sphere
from sambot_viz.session import Session
from sambot_viz.tools.picking.hit import Selectable


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    with Visualizer(port=0) as viz:
        shared = viz._server.shared  # pyright: ignore[reportPrivateUsage]
        assert shared is not None
        yield shared


def test_a_link_tells_its_pose_in_any_frame_and_where_it_is_written(
    session: Session,
) -> None:
    wheel = Selectable("link", "drivewhl_l_link")
    rows = dict(facts(session, wheel, "base_link"))
    assert rows["Parent"] == "base_link"
    assert rows["Position"] == "-0.12; 0.18; -0.05"
    assert rows["Orientation"] == "0; 0; 0; 1"
    assert rows["Written at"].startswith("sam_bot.urdf.xacro:")
    assert rows["Joint"].startswith("drivewhl_l_joint (continuous), sam_bot.urdf.xacro")
    assert dict(facts(session, wheel, "drivewhl_l_link"))["Position"] == "0; 0; 0"


def test_a_frame_that_is_gone_says_so(session: Session) -> None:
    rows = dict(facts(session, Selectable("frame", "nowhere"), "base_link"))
    assert "nowhere" in rows["Pose"]


def test_two_selected_frames_say_how_far_they_are_apart(session: Session) -> None:
    left, right = (
        Selectable("frame", "drivewhl_l_link"),
        Selectable("link", "drivewhl_r_link"),
    )
    assert apart(session.tree, left, right) == (
        "0.36 m from drivewhl_l_link to drivewhl_r_link: "
        "0; -0.36; 0 along the axes of drivewhl_l_link"
    )
    assert "nowhere" in apart(session.tree, left, Selectable("frame", "nowhere"))


def test_names_cannot_be_markup() -> None:
    html = item_html(Selectable("link", "<b>x</b>"), [("<i>", "<u>")])
    assert "<b>x" not in html and "<u>" not in html


@pytest.mark.parametrize(
    ("geometry", "words"),
    [
        (Box((1.0, 2.0, 0.5)), "Box 1; 2; 0.5 m"),
        (Sphere(0.25), "Sphere of radius 0.25 m"),
        (Cylinder(0.1, 2.0), "Cylinder of radius 0.1 m, length 2 m"),
        (MeshFile("package://a/b.stl"), "Mesh package://a/b.stl"),
    ],
)
def test_shapes_are_told_in_words(geometry: Box, words: str) -> None:
    assert geometry_text(geometry) == words


def test_a_picture_has_a_side_that_a_browser_can_draw() -> None:
    assert side(640) == 640
    for wrong in (0, 5000, float("nan"), "640", None):
        with pytest.raises(ValueError, match="16 to 4096"):
            side(wrong)


def test_the_background_is_put_behind_what_is_drawn() -> None:
    drawn = np.zeros((2, 2, 4), np.uint8)
    drawn[0, 0] = (255, 0, 0, 255)
    picture = on_background(drawn, (48, 48, 48))
    assert picture.getpixel((0, 0)) == (255, 0, 0)
    assert picture.getpixel((1, 1)) == (48, 48, 48)
