"""The Displays tree and the Problems panel in a hand: what only a browser can tell."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from desk import Desk
from inside import session_of
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer
from sambot_viz.session import Session
from sambot_viz.session.scene.scene import walk

pytestmark = pytest.mark.browser

Own = tuple[User, Session]

MODEL = """<robot name="r">
  <link name="base_link"><visual><geometry>
    <box size="1 1 1"/>
  </geometry></visual></link>
</robot>
"""
CONFIG = """
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true}
    - {Class: rviz_default_plugins/Grid, Name: Grid, Enabled: true}
    - Class: rviz_common/Group
      Name: Ground
      Enabled: true
      Displays:
        - {Class: rviz_default_plugins/Axes, Name: Axes, Enabled: true}
    - {Class: rviz_default_plugins/TF, Name: TF, Enabled: true}
  Global Options: {Fixed Frame: base_link}
"""


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Desk:
    desk = sit(MODEL, CONFIG)
    desk.user.row("Displays", "TF")
    return desk


@pytest.fixture
def user(desk: Desk) -> User:
    return desk.user


@pytest.fixture
def session(desk: Desk) -> Session:
    return desk.session


@pytest.fixture
def viz(tmp_path: Path) -> Iterator[Visualizer]:
    model, config = tmp_path / "r.urdf", tmp_path / "r.rviz"
    model.write_text(MODEL, "utf-8")
    config.write_text(CONFIG, "utf-8")
    with Visualizer(model, config, port=0) as viz:
        yield viz


@pytest.fixture
def own(viz: Visualizer, open_viewer: Callable[..., ViewerPage]) -> Own:
    """The same for what a desk cannot put back."""
    user = open_viewer(viz.url).user
    user.row("Displays", "TF")
    return user, session_of(viz)


def names(session: Session) -> list[str]:
    return [display.name for display in walk(session.document.config.displays)]


def select(user: User, *names: str) -> None:
    user.click_on(user.row("Displays", *names).all("gridcell")[0])


def test_escape_puts_a_dragged_display_back(user: User, session: Session) -> None:
    before = names(session)
    x, y = user.go_to(user.row("Displays", "TF").all("gridcell")[0])
    user.page.mouse.move(x, y)
    user.page.mouse.press()
    user.page.mouse.move(x, y - 60)
    user.keys("Escape")
    user.page.mouse.release()
    select(user, "Grid")
    user.keys("Delete")
    user.until(lambda: names(session) == [name for name in before if name != "Grid"])


def test_what_is_half_typed_stays_in_the_hand_when_others_change_the_displays(
    own: Own,
) -> None:
    user, session = own
    user.unfold("Displays", "Robot")
    select(user, "Robot", "TF Prefix")
    user.type("ab")
    session.worker.post(
        lambda: session.display_edits.add_display("rviz_default_plugins/Axes")
    )
    robot = session.document.config.displays[0]
    session.worker.post(lambda: session.display_edits.move_display(robot, 3, None))
    user.until(lambda: user.rows("Displays")[-1] == "Axes (2)")
    user.type("cd")
    user.keys("Enter")
    user.until(lambda: robot.get("TF Prefix") == "abcd")
    user.until(lambda: user.row("Displays", "Robot", "TF Prefix").state("focused"))


def test_a_name_with_a_tick_box_beside_it_has_the_room_up_to_the_box(
    own: Own,
) -> None:
    user, session = own
    name = "Wheel axes here, there"
    box = user.box(user.row("Displays", "Grid").one("checkbox"))
    session.display_edits.rename_display(session.scene.displays[0].config, name)
    label = user.row("Displays", name).one("StaticText", name)
    user.until(lambda: not user.is_cut_off(label))
    # The boxes of short names stay in line.
    assert user.box(user.row("Displays", "Grid").one("checkbox")) == box


def test_a_refusal_moves_no_row_and_goes_with_the_next_edit(user: User) -> None:
    box = user.box(user.row("Displays", "Grid"))
    colour = user.row("Displays", "Background Color")
    user.enter(colour.one("textbox"), "300; 0; 0")
    user.reads("three whole numbers from 0 to 255")
    assert user.box(user.row("Displays", "Grid")) == box
    # It is over the view, where it covers no control and nothing cuts it off.
    left, _, width, _ = user.box(user.find("treegrid", "Displays"))
    said = user.box(user.row("Displays", "Background Color").one("alert"))
    assert left + width <= said[0] and said[0] + said[2] < 1280 and said[3] < 90
    before = "48; 48; 48"
    user.until(
        lambda: user.row("Displays", "Background Color").one("textbox").value == before
    )
    user.click_on(user.row("Displays", "TF").one("checkbox"))
    user.until(lambda: "three whole numbers" not in user.see().text)
    # So it does with Tab, and of what is empty there is a reason too.
    user.unfold("Displays", "Grid")
    user.enter(user.row("Displays", "Grid", "Cell Size").one("textbox"), "")
    user.until(
        lambda: "Enter a number" in user.row("Displays", "Grid", "Cell Size").text
    )
    user.keys("Tab")
    user.until(lambda: "Enter a number" not in user.see().text)


def test_the_first_click_selects_and_the_next_one_edits(
    user: User, session: Session
) -> None:
    def color(*names: str) -> str:
        return user.color_behind(user.row("Displays", *names))

    user.unfold("Displays", "Grid")
    user.click_on(user.row("Displays", "Grid", "Alpha").one("textbox"))
    user.until(lambda: user.row("Displays", "Grid", "Alpha").state("focused"))
    user.until(lambda: color("Grid", "Alpha") != color("TF"))
    user.reads("How opaque the lines are")
    user.click_on(user.row("Displays", "Grid", "Alpha").one("textbox"))
    user.until(
        lambda: user.row("Displays", "Grid", "Alpha").one("textbox").state("focused")
    )
    user.type("0.25")
    user.keys("Escape")
    user.until(lambda: user.row("Displays", "Grid", "Alpha").state("focused"))
    assert session.document.config.displays[1].get("Alpha") == 0.5


def test_displays_with_errors_are_counted_and_one_click_leads_to_the_first(
    user: User, session: Session
) -> None:
    # Nothing that can be clicked is moved by it.
    place = user.box(user.find("button", "No problems"))
    grid = session.scene.displays[1]
    session.worker.post(
        lambda: session.display_edits.set_property(grid, "Reference Frame", "nowhere")
    )
    assert user.box(user.find("button", "No other problems")) == place
    user.menu("Panels", "Displays")
    user.gone("treegrid", "Displays")
    user.click("button", "1 display in Error")
    user.until(lambda: user.row("Displays", "Grid").state("focused"))
    user.row("Displays", "Grid", "Status", "Transform")
    user.click("button", "Use <Fixed Frame>")
    user.find("button", "No problems")
