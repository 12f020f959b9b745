"""Menus, dialogs and files of the page, used by mouse and keys."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from desk import Desk
from inside import session_of
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer, bundled

pytestmark = pytest.mark.browser

Open = Callable[..., ViewerPage]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    text = bundled.config_path().read_text("utf-8")
    (tmp_path / "mine.rviz").write_text(text, "utf-8")
    other = text.replace("Name: Grid", "Name: Floor").replace("- /TF1", "- /Floor1")
    view = "Class: rviz_default_plugins/Orbit"
    other = other.replace(view, f"{view}\n      Distance: 7")
    (tmp_path / "other.rviz").write_text(other, "utf-8")
    return tmp_path


@pytest.fixture
def viz(folder: Path) -> Iterator[Visualizer]:
    with Visualizer(config=folder / "mine.rviz", port=0, watch=True) as viz:
        yield viz


@pytest.fixture
def viewer(viz: Visualizer, open_viewer: Open, tmp_path: Path) -> ViewerPage:
    viewer = open_viewer(viz.url)
    downloads = tmp_path / "downloads"
    downloads.mkdir()
    viewer.page.take_downloads(downloads)
    return viewer


@pytest.fixture
def user(viewer: ViewerPage) -> User:
    viewer.user.row("Displays", "Grid")
    return viewer.user


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Desk:
    """A page for what leaves the files alone."""
    desk = sit("S")
    desk.user.row("Displays", "Grid")
    return desk


def title(user: User) -> str:
    return str(user.page.evaluate("document.title"))


def choose(user: User, menu: str, entry: str) -> None:
    user.click("menuitem", menu)
    user.click("menuitem", re.compile(f"^{re.escape(entry)}"))


def change_the_frame_rate(user: User, rate: int) -> None:
    field = user.row("Displays", "Global Options", "Frame Rate").one("textbox")
    user.enter(field, str(rate))
    user.until(lambda: title(user).startswith("mine.rviz*"))


def distance(user: User) -> str:
    return str(user.row("Views", "Current View", "Distance").one("textbox").value)


def focused(user: User) -> str:
    script = "((e) => e.getAttribute('aria-label') || e.textContent)"
    return str(user.page.evaluate(f"{script}(document.activeElement)")).strip()


def test_the_menus_follow_the_keys_of_a_menu_bar(desk: Desk) -> None:
    user = desk.user
    user.click("menuitem", "File")
    user.find("menu", "File")
    user.keys("ArrowDown", "ArrowDown")
    user.until(lambda: focused(user).startswith("Save Config As"))
    user.keys("ArrowRight")
    user.find("menu", "Edit")
    user.keys("ArrowLeft", "ArrowLeft")
    user.find("menu", "Help")
    user.keys("a")
    user.until(lambda: focused(user) == "About")
    user.keys("Escape")
    user.gone("menu", "Help")
    user.until(lambda: focused(user) == "Help")
    user.keys("Enter", "End", "Enter")
    dialog = user.find("dialog", re.compile("About"))
    assert re.search(r"sambot-viz \d+\.\d+", dialog.text)
    user.keys("Escape")
    user.gone("dialog")
    user.until(lambda: focused(user) == "Help")


def test_keys_of_the_window_do_nothing_while_a_dialog_is_open(desk: Desk) -> None:
    user = desk.user
    choose(user, "Help", "Keys")
    user.find("dialog", "Keys")
    user.keys("m", "h", "n")
    user.keys("Escape")
    user.gone("dialog")
    assert user.find("button", "Interact").state("pressed")
    user.row("Displays", "Grid")


def test_opening_asks_about_changes_and_shows_what_was_saved(
    user: User, viz: Visualizer, folder: Path
) -> None:
    change_the_frame_rate(user, 12)
    user.unfold("Displays", "Grid")
    user.enter(user.row("Views", "Current View", "Distance").one("textbox"), "3")
    choose(user, "File", "Open Config")
    user.find("dialog", "Unsaved changes")
    user.click("button", "Save", ("dialog", "Unsaved changes"))
    user.find("dialog", "Open Config")
    user.click("option", "other.rviz")
    user.click("button", "Open")
    user.gone("dialog")
    user.until(lambda: title(user).startswith("other.rviz"))
    assert session_of(viz).document.config.displays[0].name == "Floor"
    user.row("Displays", "Floor", "Cell Size")
    user.until(lambda: "Show Names" not in user.rows("Displays"))
    user.until(lambda: distance(user) == "7")
    # The first one again: Grid was unfolded when it was saved, and so was TF.
    choose(user, "File", "Open Config")
    user.click("option", "mine.rviz")
    user.keys("Enter")
    user.gone("dialog")
    user.row("Displays", "Grid", "Cell Size")
    user.row("Displays", "TF", "Show Names")
    user.until(lambda: distance(user) == "3")
    assert session_of(viz).document.config.global_options.get("Frame Rate") == 12


def test_panels_are_hidden_and_shown_again_from_the_menu(desk: Desk) -> None:
    user = desk.user
    choose(user, "Panels", "Hide all")
    user.gone("treegrid")
    user.click("button", re.compile("Show panels"))
    user.row("Displays", "Grid")
    user.click("menuitem", "Panels")
    user.click("menuitemcheckbox", "Displays")
    user.gone("treegrid", "Displays")
    user.click("menuitem", "Panels")
    user.click("menuitemcheckbox", "Displays")
    user.row("Displays", "Grid")


@pytest.mark.view
def test_widgets_of_a_script_have_a_panel_only_while_there_are_any(desk: Desk) -> None:
    user, viz = desk.user, desk.viz
    assert not user.there("button", "Blink")
    pressed: list[bool] = []
    button = viz.viser.gui.add_button("Blink")
    button.on_click(lambda _: pressed.append(True))
    user.click("button", "Blink")
    user.until(lambda: bool(pressed))
    button.remove()
    user.until(
        lambda: not user.there("button", "Blink") and "Script" not in user.see().text
    )


@pytest.fixture
def private_viz() -> Iterator[Visualizer]:
    with Visualizer(port=0, session="private", look="rviz") as viz:
        yield viz


def test_a_visitor_downloads_and_is_asked_before_leaving_with_changes(
    private_viz: Visualizer, open_viewer: Open
) -> None:
    leaving = (
        "(() => { const leave = new Event('beforeunload', {cancelable: true});"
        " return !dispatchEvent(leave); })()"
    )
    user = open_viewer(private_viz.url).user
    user.row("Displays", "Grid")
    user.click("menuitem", "File")
    entries = ["Download Config", "Save Image…", "Export Page…"]
    user.until(
        lambda: [e.name for e in user.find("menu", "File").all("menuitem")] == entries
    )
    user.keys("Escape")
    user.keys("Control+s")
    user.reads("Download Config saves it on your computer")
    assert not user.page.evaluate(leaving)
    field = user.row("Displays", "Global Options", "Frame Rate").one("textbox")
    user.enter(field, "12")
    user.until(lambda: user.page.evaluate(leaving))
