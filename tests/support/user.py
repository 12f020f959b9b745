"""A user at a page: finds things by role and name, and uses mouse, keys and fingers.

    user = User(page)
    user.click("button", "Add")
    user.enter(user.row("Joints", "left_wheel_joint").one("textbox"), "1.5")
    user.until(lambda: viz.joint_positions["left_wheel_joint"] == 1.5)

What is not on the screen is scrolled to with the wheel or a finger. What lies under
something else cannot be clicked. Everything waits until the page has what is asked for.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from itertools import pairwise
from typing import Any, TypeVar, cast

from ax_tree import Name, Role, Thing, look, rows_of
from browser_input import Button, Point
from patience import NOT_YET, until
from recorded_page import RecordedPage

from sambot_viz.export.devtools import BrowserError

T = TypeVar("T")
PATIENCE = 10.0
"""How long a user waits for something to appear [s]."""
_LEAVES = ("button", "checkbox", "menuitem", "option", "slider", "tab", "textbox")
"""Roles of things that nothing is looked for in."""
_SLOP = 16.0
"""How far a finger goes before a browser scrolls [CSS pixels]."""

# Where an element is, how much of it can be seen, what can be scrolled to show more,
# and what lies over the middle of what can be seen.
_PLACE = """async function () {
  await new Promise(done => { requestAnimationFrame(done); setTimeout(done, 100); });
  const element = this.nodeType === 3 ? this.parentElement : this;
  let range = element;
  if (this.nodeType === 3) { range = document.createRange(); range.selectNode(this); }
  const box = ({left, top, right, bottom}) => ({left, top, right, bottom});
  const cut = (a, b) => ({left: Math.max(a.left, b.left), top: Math.max(a.top, b.top),
    right: Math.min(a.right, b.right), bottom: Math.min(a.bottom, b.bottom)});
  const all = box(range.getBoundingClientRect());
  let seen = cut(all, {left: 0, top: 0, right: innerWidth, bottom: innerHeight});
  const scrollers = [];
  let fixed = getComputedStyle(element).position === "fixed";
  for (let e = element.parentElement; e && !fixed; e = e.parentElement) {
    const style = getComputedStyle(e);
    if (style.overflowX !== "visible" || style.overflowY !== "visible") {
      const area = box(e.getBoundingClientRect());
      seen = cut(seen, area);
      const can = /auto|scroll/;
      const down = e.scrollHeight > e.clientHeight + 1 && can.test(style.overflowY);
      const across = e.scrollWidth > e.clientWidth + 1 && can.test(style.overflowX);
      if (down || across) scrollers.push({...area, down, across});
    }
    fixed = style.position === "fixed";
  }
  const x = (seen.left + seen.right) / 2, y = (seen.top + seen.bottom) / 2;
  const hit = document.elementFromPoint(x, y);
  const free = hit !== null && (element.contains(hit)
    || [...(element.labels || [])].some(label => label.contains(hit)));
  const over = hit ? hit.outerHTML.slice(0, 120) : "";
  return {all, seen, scrollers, x, y, free, over};
}"""
_MARK = """function () {
  const mark = this.querySelector("[aria-hidden=true]");
  return mark ? (({left, top, width, height}) =>
    [left + width / 2, top + height / 2])(mark.getBoundingClientRect()) : null;
}"""

_PICK = """function () {
  this.focus();
  this.value = COLOR;
  for (const kind of ["input", "change"]) {
    this.dispatchEvent(new Event(kind, {bubbles: true}));
  }
}"""
_HAS_OPTION = """function () {
  const fits = [...this.options].map(o => o.label.toLowerCase().startsWith(OPTION));
  return [fits.includes(true), fits[this.selectedIndex] === true];
}"""
_BEHIND = """function() {
  return getComputedStyle(this.closest(".row")).backgroundColor;
}"""
_MARKED = """function () {
  return this.type === "number"
    ? false : this.selectionEnd - this.selectionStart === this.value.length;
}"""
_IS_LINE = "function () { return this.matches('.line, .lines'); }"
_HAS_FOCUS = "function () { return document.activeElement === this; }"
_CUT_OFF = """function () {
  const element = this.nodeType === 3 ? this.parentElement : this;
  return element.scrollWidth > element.clientWidth + 1;
}"""
_TIP = """(() => {
  const under = document.elementFromPoint(X, Y)?.closest("[title]");
  return under ? under.title : "";
})()"""


class User:
    """A user at one page.

    Args:
        page: the page.
        finger: whether there is a touch screen in place of mouse and keys.
    """

    def __init__(self, page: RecordedPage, finger: bool = False) -> None:
        self.page = page
        self.finger = finger
        page.call("Accessibility.enable")

    # Looking.

    def see(self) -> Thing:
        """All that the page shows now."""
        return look(self.page)

    def until(
        self, condition: Callable[[], T], timeout: float = PATIENCE, why: str = ""
    ) -> T:
        """Return what a condition gives as soon as it is true.

        A condition that raises an AssertionError or ValueError is not true yet.

        Raises:
            AssertionError: it did not become true within `timeout` seconds.
        """
        return until(condition, timeout, why, (*NOT_YET, BrowserError))

    def find(self, role: Role, name: Name = None, *inside: tuple[Role, Name]) -> Thing:
        """Wait for the only thing of a role and name.

        Args:
            role: its ARIA role.
            name: its accessible name.
            inside: role and name of what it is in, from the outside.
        """

        def found() -> Thing:
            thing = self.see()
            for around in inside:
                thing = thing.one(*around)
            thing = thing.one(role, name)
            return thing if role in _LEAVES else thing.look_inside()

        return self.until(found)

    def there(self, role: Role, name: Name = None) -> bool:
        """Whether there is something of a role and name now."""
        return bool(self.see().all(role, name))

    def gone(self, role: Role, name: Name = None) -> None:
        """Wait until nothing of a role and name is there."""
        self.until(lambda: not self.there(role, name), why=f"{role} {name!r} is there")

    def row(self, panel: str, *names: str) -> Thing:
        """Wait for the row of a panel with the last name, below rows with those before.

        Levels between may be left out; of several rows the one with the fewest is
        meant: a status may have the name of a property. A name may leave out what
        stands behind a colon, as in "Status: Ok". The user scrolls to a row out of
        sight, which is only a line of text there.
        """

        def found() -> Thing:
            rows = rows_of(self.see().one("treegrid", panel))
            fitting = [(path, row) for path, row in rows if _is_path(path, names)]
            if fitting:
                row = min(fitting, key=lambda found: len(found[0]))[1]
                if self._ask(row, _IS_LINE):
                    self.go_to(row)
                    raise AssertionError(f"{names} in {panel} is out of sight")
                return row.look_inside()
            known = [path[-1] for path, _ in rows if path[-1]]
            raise AssertionError(f"no row {names} in {panel}; there are {known}")

        return self.until(found)

    def rows(self, panel: str) -> list[str]:
        """The labels of the rows of a panel that are unfolded."""
        return [path[-1] for path, _ in rows_of(self.see().one("treegrid", panel))]

    def new_row(self, panel: str, before: Sequence[str]) -> str:
        """Wait for a row that was not in a panel before; return its label.

        A row whose cells are not known yet is called after all that is in it; they may
        come between the two questions.
        """

        def found() -> str:
            for path, row in rows_of(self.see().one("treegrid", panel)):
                if path[-1] in before:
                    continue
                cells = row.all("gridcell")
                if cells[0].name == path[-1] if cells else self._ask(row, _IS_LINE):
                    return path[-1]
            raise AssertionError(f"no row in {panel} but {before}")

        return self.until(found)

    def reads(self, text: str, timeout: float = PATIENCE) -> None:
        """Wait until the page shows a text."""
        self.until(lambda: text in self.see().text, timeout, f"{text!r} is not shown")

    def place(self, thing: Thing) -> dict[str, Any]:
        """Where a thing is, and how much of it can be seen [CSS pixels]."""
        return cast("dict[str, Any]", self._ask(thing, _PLACE))

    def box(self, thing: Thing) -> tuple[float, float, float, float]:
        """Left, top, width and height of a thing [CSS pixels]."""
        box = self.place(thing)["all"]
        left, top = box["left"], box["top"]
        return left, top, box["right"] - left, box["bottom"] - top

    def can_see(self, thing: Thing) -> bool:
        """Whether all of a thing is on the screen, and nothing lies over it."""
        place = self.place(thing)
        return bool(place["free"]) and _is_whole(place)

    def is_cut_off(self, thing: Thing) -> bool:
        """Whether some of a text does not fit and is left out, as by an ellipsis."""
        return bool(self._ask(thing, _CUT_OFF))

    def has_tip(self, text: str) -> None:
        """Wait until the text that a browser shows where the mouse is begins so."""
        x, y = self.page.mouse.at
        tip = _TIP.replace("X", str(x)).replace("Y", str(y))
        self.until(
            lambda: str(self.page.evaluate(tip)).startswith(text),
            why=f"the mouse is not over what says {text!r}",
        )

    @property
    def clipboard(self) -> str:
        """The text on the clipboard."""
        return str(self.page.evaluate("navigator.clipboard.readText()"))

    # Mouse and finger.

    def click(self, role: Role, name: Name = None, *inside: tuple[Role, Name]) -> Thing:
        """Click what `find` finds."""
        thing = self.find(role, name, *inside)
        self.click_on(thing)
        return thing

    def click_on(self, thing: Thing, button: Button = "left", *modifiers: str) -> None:
        """Click, or tap with the finger, into the middle of a thing."""
        x, y = self.go_to(thing)
        if self.finger:
            self.page.touch.tap(x, y)
        else:
            self.page.mouse.click(x, y, button, *modifiers)

    def go_to(self, thing: Thing) -> Point:
        """Scroll to a thing; the middle of what can be seen of it.

        Raises:
            AssertionError: it cannot be brought to the screen, or is covered.
        """
        before: object = None
        for _ in range(200):
            place = self.place(thing)
            if _is_whole(place) and place["all"] == before:
                break
            # What moves by itself is waited for, what is hidden is scrolled to.
            if place["all"] == before:
                self._scroll(thing, place)
            before = place["all"]
        else:
            raise AssertionError(f"{thing.role} {thing.name!r} is not on the screen")
        assert place["free"], f"over {thing.role} {thing.name!r} lies {place['over']}"
        return place["x"], place["y"]

    def _scroll(self, thing: Thing, place: dict[str, Any]) -> None:
        box = place["all"]
        for area in place["scrollers"]:
            x, y = (
                (area["left"] + area["right"]) / 2,
                (area["top"] + area["bottom"]) / 2,
            )
            down = _way(box["top"], box["bottom"], area["top"], area["bottom"])
            across = _way(box["left"], box["right"], area["left"], area["right"])
            if area["down"] and down:
                return self.scroll(x, y, down)
            if area["across"] and across:
                return self.scroll(x, y, 0.0, across)
        raise AssertionError(
            f"{thing.role} {thing.name!r} is cut off, and nothing there can be scrolled"
        )

    def scroll(self, x: float, y: float, dy: float, dx: float = 0.0) -> None:
        """Turn the wheel, or push with the finger, over a point [CSS pixels]."""
        if not self.finger:
            return self.page.mouse.wheel(x, y, dy, dx)
        # The first pixels decide only that it is not a tap.
        dx, dy = (d + math.copysign(_SLOP, d) if d else 0.0 for d in (dx, dy))
        self.swipe((x + dx / 2, y + dy / 2), (x - dx / 2, y - dy / 2))

    def swipe(self, start: Point, end: Point, steps: int = 10) -> None:
        """Put a finger down, move it in equal steps, and lift it."""
        self.page.touch.start(start)
        for step in range(1, steps + 1):
            x, y = (a + (b - a) * step / steps for a, b in zip(start, end, strict=True))
            self.page.touch.move((x, y))
        self.page.touch.end()

    def drag_slider(self, thing: Thing, *values: float, steps: int = 10) -> None:
        """Take the handle of a slider, pull it to some values in turn, and let go."""
        self.go_to(thing)
        left, top, width, height = self.box(thing)
        least, most = thing.states["valuemin"], thing.states["valuemax"]
        handle = 22.0 if self.finger else 14.0
        at = [
            left + handle / 2 + (width - handle) * (value - least) / (most - least)
            for value in (float(thing.value), *values)
        ]
        y, mouse, touch = top + height / 2, self.page.mouse, self.page.touch
        if self.finger:
            touch.start((at[0], y))
        else:
            mouse.move(at[0], y)
            mouse.press()
        for before, after in pairwise(at):
            for step in range(1, steps + 1):
                x = before + (after - before) * step / steps
                touch.move((x, y)) if self.finger else mouse.move(x, y)
        touch.end() if self.finger else mouse.release()

    def unfold(self, panel: str, *names: str, fold: bool = False) -> None:
        """Click the mark before the name of a row, if it is not unfolded yet."""
        # A row may also unfold by itself: then the click has folded it.
        for _ in range(3):
            row = self.row(panel, *names)
            if row.state("expanded") != fold:
                return
            self.go_to(row)
            at = cast("list[float] | None", self._ask(row, _MARK))
            assert at is not None, f"row {names} has no mark to unfold it"
            (self.page.touch.tap if self.finger else self.page.mouse.click)(*at)
            with suppress(AssertionError):
                self.until(
                    lambda: self.row(panel, *names).state("expanded") != fold, 4.0
                )
                return
        raise AssertionError(f"row {names} does not {'fold' if fold else 'unfold'}")

    def choose(self, thing: Thing, option: str) -> None:
        """Choose from a list by the keyboard: go to it and type the option."""
        self.go_to(thing)
        self.page.call("DOM.focus", {"backendNodeId": thing.node})
        has = _HAS_OPTION.replace("OPTION", json.dumps(option.lower()))
        # The list may be the one that was there before, or be filled by the focus.
        self.until(lambda: self._ask(thing, has)[0], why=f"there is no {option}")
        self.page.keyboard.type_quickly(option)
        self.until(lambda: self._ask(thing, has)[1], why=f"{option} is not chosen")

    def menu(self, *names: Name) -> None:
        """Open a menu of the window and click an entry of it."""
        head, entry = names
        self.click("menuitem", head)
        self.click(re.compile("^menuitem"), entry, ("menu", head))

    def tab(self, name: str) -> None:
        """Show a panel that has a tab."""
        self.click("tab", name)
        self.find("tabpanel", name)

    def pick_color(self, thing: Thing, color: str) -> None:
        """Choose a colour such as "#ff0000" in the window that a colour field opens.

        That window is the system's, where tests have no mouse: what it does is done.
        """
        self.go_to(thing)
        self._ask(thing, _PICK.replace("COLOR", json.dumps(color)))

    # Keys.

    def keys(self, *keys: str) -> None:
        """Press keys: characters, names as in JavaScript, or "Control+Shift+z"."""
        for key in keys:
            *modifiers, last = key.split("+") if len(key) > 1 else [key]
            self.page.keyboard.press(last, *modifiers)

    def type(self, text: str) -> None:
        """Press the key of each character."""
        self.page.keyboard.type(text)

    def click_into(self, thing: Thing) -> None:
        """Click into a field: in a tree, the first click only selects its row."""
        if thing.state("focused"):
            return
        for _ in range(2):
            self.click_on(thing)
            if self._ask(thing, _HAS_FOCUS):
                return
        raise AssertionError(f"{thing.role} {thing.name!r} does not get the keys")

    def enter(self, thing: Thing, text: str, end: str = "Enter") -> None:
        """Click into a field, mark what is in it, type, and end with a key."""
        self.click_into(thing)
        if not self._ask(thing, _MARKED):
            self.keys("Control+a")
        if not text:
            self.keys("Delete")
        self.type(text)
        if end:
            self.keys(end)

    def color_behind(self, thing: Thing) -> str:
        """The background of a row, as CSS has it."""
        return str(self._ask(thing, _BEHIND))

    def _ask(self, thing: Thing, function: str) -> Any:
        found = self.page.call("DOM.resolveNode", {"backendNodeId": thing.node})
        answer = self.page.call(
            "Runtime.callFunctionOn",
            {
                "functionDeclaration": function,
                "objectId": found["object"]["objectId"],
                "awaitPromise": True,
                "returnByValue": True,
            },
        )
        assert "exceptionDetails" not in answer, json.dumps(answer)[:300]
        return answer["result"].get("value")


def _is_path(path: Sequence[str], names: Sequence[str]) -> bool:
    """Whether the last row of a path has the last name, below rows with the others."""
    left = list(names)
    if not _is_label(path[-1], left.pop()):
        return False
    for label in reversed(path[:-1]):
        if left and _is_label(label, left[-1]):
            left.pop()
    return not left


def _is_label(label: str, name: str) -> bool:
    return label == name or label.startswith(f"{name}:")


def _is_whole(place: dict[str, Any]) -> bool:
    """Whether all of an element can be seen, or as much as fits."""
    return all(abs(place["all"][e] - place["seen"][e]) < 1.5 for e in place["all"])


def _way(low: float, high: float, least: float, most: float) -> float:
    """How far to scroll, so that low … high comes between least and most."""
    most_at_once = 0.8 * (most - least)
    if low < least:
        return max(low - least - 4, -most_at_once)
    return min(high - most + 4, most_at_once) if high > most else 0.0
