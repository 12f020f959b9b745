"""Finding rows: the search of a panel, and Ctrl+K for everything."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from inside import session_of
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

SHOWN = r"""[...document.querySelectorAll(".window button:enabled")]
  .filter((button) => button.getClientRects().length
    && !button.closest("[role=row], [role=menubar]"))
  .map((button) => (button.getAttribute("aria-label") || button.innerText)
    .replace(/\s+/g, " ").trim())"""
FOUND = """(({ value }) => [value,
  [...document.querySelectorAll(".palette .option b")]
    .some((option) => option.textContent === value)])(document.activeElement)"""
PALETTE = "Go to a display, joint, frame or command"


@pytest.fixture(scope="module")
def user(viz_for_all: Visualizer, open_for_all: Callable[..., ViewerPage]) -> User:
    user = open_for_all(viz_for_all.url).user
    user.find("slider", "drivewhl_l_joint")
    return user


def focused_row(user: User) -> str | None:
    found: str | None = user.page.evaluate("document.activeElement.dataset.row ?? null")
    return found


def go_to(user: User, typed: str) -> None:
    """Open the palette, type, and take the first that is found."""
    user.keys("Control+k")
    user.until(lambda: user.find("combobox", PALETTE).state("focused"))
    user.type(typed)
    user.keys("Enter")
    user.gone("combobox", PALETTE)


def test_what_a_search_finds_is_edited_where_it_is(
    user: User, viz_for_all: Visualizer
) -> None:
    user.click_on(user.find("searchbox", "Search displays"))
    user.type("grid alpha")
    user.until(lambda: user.rows("Displays") == ["Grid", "Alpha"])
    user.keys("Enter", "Enter")
    user.until(
        lambda: user.row("Displays", "Grid", "Alpha").one("textbox").state("focused")
    )
    user.type("0.25")
    user.keys("Enter")
    shared = session_of(viz_for_all)
    grid = shared.document.config.displays[0]
    user.until(lambda: grid.get("Alpha") == 0.25)
    user.click_on(user.find("searchbox", "Search displays"))
    user.keys("Escape")
    user.until(lambda: "RobotModel" in user.rows("Displays"))


def test_a_search_that_finds_nothing_says_so(user: User) -> None:
    user.click_on(user.find("searchbox", "Search displays"))
    user.type("xyzzy")
    user.reads("No name has 'xyzzy' in it")
    user.keys("Escape")
    user.until(lambda: "Grid" in user.rows("Displays"))


def test_ctrl_k_goes_to_a_display_a_joint_and_a_frame(user: User) -> None:
    for typed, row in (
        ("front_cas", "frame/front_caster"),
        ("drivewhl_r_jo", "j/drivewhl_r_joint"),
    ):
        go_to(user, typed)
        user.until(lambda row=row: focused_row(user) == row)
    go_to(user, "tf marker")
    scale = ("Displays", "TF", "Marker Scale")
    user.until(lambda: user.row(*scale).state("focused"))
    # The keys are still for tools, until Enter.
    user.keys("m")
    user.until(lambda: user.find("button", "Move Camera").state("pressed"))
    user.keys("i", "Enter")
    user.until(lambda: user.row(*scale).one("textbox").state("focused"))
    user.keys("Escape")
    user.until(lambda: user.row(*scale).state("focused"))


def options(user: User, typed: str) -> list[str]:
    """What the palette finds, each with where it is."""
    user.keys("Control+k")
    user.until(lambda: user.find("combobox", PALETTE).state("focused"))
    user.type(typed)
    user.until(lambda: (user.find("combobox", PALETTE).value or "") == typed)
    return [option.name or "" for option in user.see().all("option")]


@pytest.fixture
def closed(user: User) -> Iterator[None]:
    """Close the palette at the end."""
    yield
    user.keys("Escape")
    user.gone("combobox", PALETTE)
    user.tab("Joints")


@pytest.mark.usefixtures("closed")
def test_ctrl_k_finds_what_is_called_otherwise_than_it_is(user: User) -> None:
    found = options(user, "wheel")
    for wanted in ("Wheels Drive", "drivewhl_l_joint Joints", "drivewhl_r_joint"):
        assert [one for one in found if one.startswith(wanted)], (wanted, found)


@pytest.mark.usefixtures("closed")
def test_ctrl_k_finds_each_button_whatever_tab_is_in_front(user: User) -> None:
    tabs = ["Joints", "Frames", "Selection", "Drive"]
    shown: dict[str, set[str]] = {}
    for tab in tabs:
        user.tab(tab)
        shown[tab] = set(user.page.evaluate(SHOWN))
    known = set().union(*shown.values())
    assert {"Randomize", "Degrees", "Back to start"} <= known
    for tab in tabs:
        user.tab(tab)
        options(user, "")
        # What every tab leaves in sight is looked for once.
        for name in sorted(known - shown[tab] if tab in tabs[1:] else known):
            user.keys("Control+a")
            # Letter by letter, the list is made again for each.
            user.page.keyboard.insert(name)
            user.until(
                lambda name=name: user.page.evaluate(FOUND) == [name, True],
                why=f"{name} with {tab} in front",
            )
        user.keys("Escape")


def test_ctrl_k_presses_a_button_of_a_tab_that_is_not_in_front(
    user: User, viz_for_all: Visualizer
) -> None:
    drive = session_of(viz_for_all).drive
    user.tab("Joints")
    go_to(user, "forwards")
    user.until(lambda: user.find("button", "Forwards").state("focused"))
    user.tab("Joints")
    drive.set_velocity(0.1, 0.0)
    user.until(lambda: drive.pose.x > 0)
    go_to(user, "back to start")
    user.until(lambda: not drive.moving and drive.pose.x == 0.0)
    assert user.find("tab", "Drive").state("selected")
    user.tab("Joints")


def test_ctrl_k_presses_a_button(user: User) -> None:
    user.tab("Joints")
    go_to(user, "degrees")
    user.until(lambda: user.find("button", "Degrees").state("pressed"))
    go_to(user, "degrees")
    user.until(lambda: not user.find("button", "Degrees").state("pressed"))


def test_ctrl_k_runs_a_command_and_accepts_what_is_typed_meanwhile(user: User) -> None:
    go_to(user, "measure")
    user.until(lambda: user.find("button", "Measure").state("pressed"))
    go_to(user, "interact")
    user.until(lambda: user.find("button", "Interact").state("pressed"))
    field = user.row("Joints", "drivewhl_l_joint").one("textbox")
    user.click_into(field)
    user.type("0.5")
    user.keys("Control+k")
    user.until(lambda: user.find("combobox", PALETTE).state("focused"))
    user.keys("Escape")
    user.until(
        lambda: user.row("Joints", "drivewhl_l_joint").one("textbox").value == "0.5"
    )
    user.until(lambda: "INPUT" == user.page.evaluate("document.activeElement.tagName"))
