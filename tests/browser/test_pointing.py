"""Between the rows of joints and the links in the view."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import robots
from inside import node_of
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

# The glow of a link and the needle on its axis are drawn after everything else.
GLOWING = """(() => {
  const found = [];
  __viserMutable.scene.traverse(o => { if (o.renderOrder === 10) found.push(o); });
  return found.length;
})()"""
# How thick the needle is, as a part of the picture's height.
THICK = """(() => {
  const { scene, camera } = __viserMutable;
  let needle;
  scene.traverse(o => {
    if (o.renderOrder === 10 && !o.material.depthTest) needle ||= o;
  });
  const a = needle.getWorldPosition(camera.position.clone()), b = a.clone();
  const up = b.clone().set(0, 1, 0).applyQuaternion(camera.quaternion);
  b.addScaledVector(up, needle.scale.x);
  return (b.project(camera).y - a.project(camera).y) / 2;
})()"""
# The camera of a view without perspective is there.
FAR_AWAY = """(() => {
  const { camera } = __viserMutable;
  return camera.fov < 1 && camera.position.length() > 20;
})()"""
AT = """(() => {
  const { nodeRefFromName: nodes, camera, canvas } = __viserMutable;
  const at = nodes["NODE"].getWorldPosition(camera.position.clone()).project(camera);
  const { left, top, width, height } = canvas.getBoundingClientRect();
  return [left + (at.x + 1) / 2 * width, top + (1 - at.y) / 2 * height];
})()"""
LEFT = "drivewhl_l_joint"


@pytest.fixture(scope="module")
def viewer(
    viz_for_all: Visualizer, open_for_all: Callable[..., ViewerPage]
) -> ViewerPage:
    viewer = open_for_all(viz_for_all.url, view=True)
    viewer.user.find("slider", LEFT)
    viewer.settle(viz_for_all)
    return viewer


def test_a_row_under_the_mouse_lights_its_link_and_nothing_stays(
    viewer: ViewerPage,
) -> None:
    user, page = viewer.user, viewer.page
    x, y, _, height = user.box(user.row("Joints", LEFT))
    page.mouse.move(x + 20, y + height / 2)
    user.until(lambda: page.evaluate(GLOWING) == 3)
    page.mouse.move(x - 300, y + 300)
    user.until(lambda: page.evaluate(GLOWING) == 0)
    user.click("button", "Degrees")
    assert page.evaluate(GLOWING) == 0
    # The field of the turn rate, then the row.
    user.keys("Tab", "Tab")
    user.until(lambda: page.evaluate(GLOWING) == 3)
    user.click("button", "Degrees")
    user.until(lambda: page.evaluate(GLOWING) == 0)


def test_the_needle_is_as_thin_in_a_view_without_perspective(
    viewer: ViewerPage,
) -> None:
    user, page = viewer.user, viewer.page
    x, y, _, height = user.box(user.row("Joints", LEFT))
    page.mouse.move(x - 300, y + 300)
    user.keys("1")
    user.until(lambda: page.evaluate(FAR_AWAY))
    page.mouse.move(x + 20, y + height / 2)
    user.until(lambda: page.evaluate(GLOWING) == 3)
    assert page.evaluate(THICK) == pytest.approx(0.005, rel=0.1)
    page.mouse.move(x - 300, y + 300)
    user.until(lambda: page.evaluate(GLOWING) == 0)
    user.keys("z")
    user.until(lambda: not page.evaluate(FAR_AWAY))


def test_a_double_click_on_a_link_goes_to_its_joint(
    viz_for_all: Visualizer, viewer: ViewerPage
) -> None:
    user, page = viewer.user, viewer.page
    user.click("tab", "Frames")
    user.find("treegrid", "Frames")
    x, y = page.evaluate(AT.replace("NODE", node_of(viz_for_all, "drivewhl_l_link")))
    page.mouse.double_click(x, y)
    user.until(
        lambda: page.evaluate("document.activeElement.dataset.row ?? ''") == f"j/{LEFT}"
    )


def test_names_of_joints_are_whole_beside_a_joint_with_a_turn_button(
    tmp_path: Path, open_viewer: Callable[..., ViewerPage]
) -> None:
    model = tmp_path / "humanoid.urdf"
    head = 'name="head_yaw_joint" type='
    text = robots.humanoid().replace(f'{head}"revolute"', f'{head}"continuous"')
    model.write_text(text, "utf-8")
    with Visualizer(model, port=0, look="rviz") as viz:
        user = open_viewer(viz.url, dark=True).user
        user.find("button", "Turn head_yaw_joint")
        for name in ("head_yaw_joint", "left_wrist_pitch_joint"):
            row = user.row("Joints", name)
            (label,) = row.all("gridcell", name)[0].all("StaticText")
            assert not user.is_cut_off(label)
            left, _, width, _ = user.box(row.one("slider"))
            assert width > 40.0 and left > 900.0
