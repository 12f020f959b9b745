"""The look Studio: chosen in the menu View, kept by the browser, and drawn."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import two_colour_quads as quads
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = [pytest.mark.browser, pytest.mark.view]

Open = Callable[..., ViewerPage]
LOOK = "window.sambotVizLook"


@pytest.fixture
def viewer(make_viz: Callable[..., Visualizer], open_viewer: Open) -> ViewerPage:
    """A page that begins with RViz's look."""
    viz = make_viz(look="rviz")
    viewer = open_viewer(viz.url)
    viewer.wait_for(f"{LOOK}?.labels === 5")
    viewer.settle(viz)
    return viewer


def choose(viewer: ViewerPage, look: str) -> None:
    viewer.user.click("menuitem", "View")
    viewer.user.click("menuitemcheckbox", f"Look: {look}")


def test_the_menu_changes_the_look_and_back_and_the_browser_keeps_it(
    viewer: ViewerPage,
) -> None:
    before = viewer.pixels()
    assert viewer.page.evaluate(f"{LOOK}.studio") == 0
    choose(viewer, "Studio")
    viewer.wait_for(f"{LOOK}.studio > 0")
    viewer.user.until(lambda: not np.array_equal(viewer.pixels(), before))
    choose(viewer, "RViz")
    viewer.user.until(lambda: np.array_equal(viewer.pixels(), before))
    choose(viewer, "Studio")
    viewer.page.goto(viewer.url)
    viewer.wait_for(f"{LOOK}?.studio > 0 && {LOOK}.lit === 0")


PLAIN = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true}
  Global Options: {Fixed Frame: base_link}
  Views:
    Current:
      Class: rviz_default_plugins/TopDownOrtho
      Target Frame: base_link
      Scale: 80
      X: 2.5
      Y: 2
"""


def test_every_mesh_keeps_its_texture_and_its_colours_in_studio(
    tmp_path: Path, make_viz: Callable[..., Visualizer], open_viewer: Open
) -> None:
    """For each format, attribute and with or without normals, as RViz's look shows."""
    quads.write(tmp_path)
    places = {name: (n % 5, n // 5) for n, name in enumerate(quads.names())}
    visuals = "".join(
        f'<visual><origin xyz="{x} {y} 0"/>'
        f'<geometry><mesh filename="{name}"/></geometry></visual>'
        for name, (x, y) in places.items()
    )
    model = tmp_path / "quads.urdf"
    model.write_text(
        f'<robot name="quads"><link name="base_link">{visuals}</link></robot>'
    )
    config = tmp_path / "plain.rviz"
    config.write_text(PLAIN)
    with Visualizer(model, config, port=0, look="rviz") as viz:
        viewer = open_viewer(viz.url)
        viewer.settle(viz)
        in_rviz = colours_of(viewer, places)
        choose(viewer, "Studio")
        viewer.wait_for(f"{LOOK}.studio > 0 && {LOOK}.waiting === 0")
        viewer.settle(viz)
        assert colours_of(viewer, places) == in_rviz
    # The samples are what they are meant to be.
    textured = {in_rviz[name] for name in places if name.startswith(("uv", "both"))}
    assert textured == {("R", "G")}


def colours_of(
    viewer: ViewerPage, places: dict[str, tuple[int, int]]
) -> dict[str, tuple[str, str]]:
    """Which of R, G, B each mesh shows on its left and right, "RG" for yellow."""
    pixels = viewer.pixels()

    def strong(x: float, y: float) -> str:
        column, row = viewer.project("", (x, y, 0.0))
        rgb = [int(value) for value in pixels[row, column, :3]]
        return "".join(
            c for c, v in zip("RGB", rgb, strict=True) if v > 0.75 * max(rgb)
        )

    return {
        name: (strong(x + 0.15, y + 0.4), strong(x + 0.75, y + 0.4))
        for name, (x, y) in places.items()
    }
