"""Menus, dialogs and files of the page, used by mouse and keys."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from desk import Desk
from user import User
from viewer_page import ViewerPage

from sambot_viz import Visualizer

pytestmark = pytest.mark.browser

Open = Callable[..., ViewerPage]


@pytest.fixture
def desk(sit: Callable[..., Desk]) -> Desk:
    """A page for what leaves the files alone."""
    desk = sit("S")
    desk.user.row("Displays", "Grid")
    return desk


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
    # The keys of the window do nothing meanwhile.
    user.keys("m", "h", "n")
    user.keys("Escape")
    user.gone("dialog")
    user.until(lambda: focused(user) == "Help")
    assert user.find("button", "Interact").state("pressed")
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


# How many dialogs are shown from now on, however short.
_COUNT_DIALOGS = """(() => {
  window.dialogs = 0;
  const show = HTMLDialogElement.prototype.showModal;
  HTMLDialogElement.prototype.showModal = function () {
    window.dialogs += 1;
    return show.call(this);
  };
})()"""


def test_configs_of_before_are_in_the_menu_and_open_again(
    tmp_path: Path, open_viewer: Open
) -> None:
    for name in ("one", "two"):
        grid = f"{{Class: rviz_default_plugins/Grid, Name: Grid {name}}}"
        text = f"Visualization Manager:\n  Displays:\n    - {grid}\n"
        (tmp_path / f"{name}.rviz").write_text(text)
    with Visualizer(config=tmp_path / "one.rviz", port=0) as viz:
        user = open_viewer(viz.url).user
        user.row("Displays", "Grid one")
        user.click("menuitem", "File")
        assert not user.there("menuitem", re.compile("^Recent"))
        user.click("menuitem", "Open Config…")
        user.click("option", "two.rviz")
        user.click("button", "Open")
        user.row("Displays", "Grid two")
        user.gone("dialog")
        user.page.evaluate(_COUNT_DIALOGS)
        user.click("menuitem", "File")
        user.click("menuitem", "Recent: one.rviz")
        user.row("Displays", "Grid one")
        # Nothing to read has come and gone.
        assert user.page.evaluate("dialogs") == 0
        # What cannot be opened says why.
        (tmp_path / "two.rviz").unlink()
        user.click("menuitem", "File")
        user.click("menuitem", "Recent: two.rviz")
        user.find("dialog", "Open Config")
        assert "two.rviz" in user.find("alert", None, ("dialog", "Open Config")).text
        user.keys("Escape")
        user.gone("dialog")


@pytest.mark.view
def test_pages_open_with_their_panels_hidden_where_asked(open_viewer: Open) -> None:
    with Visualizer(port=0, fullscreen=True) as viz:
        user = open_viewer(viz.url).user
        user.click("button", "Show panels (H)")
        user.row("Displays", "Grid")
