"""Presses everything that can be pressed in a page, and sees whether anything moves.

    assert press_all(viewer) == []

Real presses, at the middle of each control that is in sight. Their clicks are taken
away: what a click does may move things, a press, a hover and the focus must not.
Otherwise the click is lost, or is for something else.
"""

from __future__ import annotations

import json
from typing import Any

from viewer_page import ViewerPage

_PLACES = """(() => {
  const CONTROLS = `button, input, select, textarea, a[href], label.tick,
    .twist:not(.none), [role=row], [role=option], [role^=menuitem],
    [role=separator][tabindex]`;
  const box = (one) => {
    const { left, top, width, height } = one.getBoundingClientRect();
    // Of a line that is dragged only the end moves when rows come.
    return one.matches("[role=separator]") ? [left, top] : [left, top, width, height];
  };
  const middle = (one) => {
    const { left, top, width, height } = one.getBoundingClientRect();
    return [left + width / 2, top + height / 2];
  };
  const isHit = (one, at) => one.contains(document.elementFromPoint(...at));
  const said = (one) => {
    const role = one.getAttribute("role") || one.tagName.toLowerCase();
    const words = (one.ariaLabel || one.textContent).trim().replace(/\\s+/g, " ");
    return `${role} '${words.slice(0, 40)}'`;
  };
  const drawn = () =>
    new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  const places = {
    holds: false,
    all: [],
    faults: [],
    find(within) {
      this.all = [...document.querySelectorAll(within)]
        .flatMap((part) => [...part.querySelectorAll(CONTROLS)])
        .filter((one) => !one.disabled && isHit(one, middle(one)));
      this.faults = [];
      return this.all.length;
    },
    remember() {
      const here = [...document.querySelectorAll(CONTROLS)];
      this.boxes = new Map(here.map((one) => [one, box(one)]));
    },
    compare(what, at) {
      const moved = [...this.boxes].filter(([one, before]) =>
        one.isConnected
          && box(one).some((value, i) => Math.abs(value - before[i]) > 0.5));
      if (moved.length) {
        const [one, before] = moved[0];
        this.faults.push(`${what} moves ${said(one)} and ${moved.length - 1} others:`
          + ` ${before} to ${box(one)}`);
      }
    },
    before(i) {
      const one = this.all[i], at = middle(one);
      this.remember();
      return one.isConnected && isHit(one, at) ? at : null;
    },
    async after(i, at) {
      await drawn();
      const one = this.all[i];
      const under = document.elementFromPoint(...at)?.className;
      if (!isHit(one, at))
        this.faults.push(`pressing ${said(one)}: at ${at} is ${under}`);
      this.compare(`pressing ${said(one)}`);
    },
    async focus() {
      for (const one of this.all) {
        if (one.tabIndex < 0 || !one.isConnected) continue;
        this.remember();
        one.focus({ preventScroll: true });
        await new Promise(setTimeout);
        this.compare(`focusing ${said(one)}`);
      }
    },
  };
  addEventListener("click", (event) => {
    if (!places.holds) return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }, true);
  return window.places = places;
})()"""


def press_all(viewer: ViewerPage, within: str = "#sambot", least: int = 1) -> list[str]:
    """Press each control in sight in turn; what was moved by it.

    Args:
        viewer: the page; with a touch screen, fingers press.
        within: a selector of where the controls are; whether any control of the
            page moves is looked at.
        least: how many there are at least.
    """
    page = viewer.page
    page.evaluate(f"window.places ??= {_PLACES}; 0")
    count = page.evaluate(f"places.find({json.dumps(within)})")
    assert count >= least, f"{count} controls within {within}"
    page.evaluate("places.holds = true; 0")
    for number in range(count):
        at: Any = page.evaluate(f"places.before({number})")
        if at is None:
            continue
        if viewer.user.finger:
            page.touch.start(at)
        else:
            page.mouse.move(*at)
            page.mouse.press()
        page.evaluate(f"places.after({number}, {at})")
        (page.touch.end if viewer.user.finger else page.mouse.release)()
    page.evaluate("places.focus()")
    page.evaluate("places.holds = false; 0")
    faults: Any = page.evaluate("places.faults")
    return faults
