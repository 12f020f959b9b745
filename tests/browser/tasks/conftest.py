"""Desks that the tasks share, and their order, which is another one every time."""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from desk import Desk
    from viewer_page import ViewerPage

    from sambot_viz.export.chromium import Chromium

_HERE = Path(__file__).parent


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Shuffle the tasks among their own places: none may depend on another."""
    places = [n for n, item in enumerate(items) if _HERE in item.path.parents]
    tasks = [items[n] for n in places]
    random.Random(int(os.environ["SAMBOT_VIZ_TASK_SEED"])).shuffle(tasks)
    for place, task in zip(places, tasks, strict=True):
        items[place] = task


@pytest.fixture(autouse=True)
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A robot goes on driving, however long a page of a busy machine says nothing."""
    from sambot_viz.panels import drive_panel

    monkeypatch.setattr(drive_panel, "KEEP", 600.0)


def pages_of(desk: Desk) -> Iterator[Callable[..., ViewerPage]]:
    """Open more pages of a desk: ``open_more(390, 844, touch=True)``."""
    opened: list[ViewerPage] = []

    def more(*size: int, touch: bool = False, address: str = "") -> ViewerPage:
        opened.append(desk.open(*size, touch=touch, address=address))
        # A slider that moves to its place while it is taken does not come along.
        opened[-1].settle(desk.viz)
        return opened[-1]

    yield more
    desk.undo_of_others()
    for viewer in opened:
        viewer.page.close()
    for viewer in opened:
        assert viewer.errors() == []


@pytest.fixture
def s(sit: Callable[..., Desk]) -> Desk:
    """The small two-wheeled robot that comes with the program."""
    return sit("S")


@pytest.fixture
def files(sit: Callable[..., Desk]) -> Desk:
    """The same robot, for tasks that open and save configs."""
    return sit("S files")


@pytest.fixture
def make_desk(
    chromium: Chromium, tmp_path: Path, view: bool
) -> Iterator[Callable[[str], Desk]]:
    """A desk for one task alone: ``make_desk("S")``, or with the text of a model."""
    from desk import Desk

    made: list[Desk] = []

    def make(letter: str) -> Desk:
        folder = tmp_path / f"desk{len(made)}"
        made.append(Desk(letter, chromium, folder, view=view))
        return made[-1]

    yield make
    for desk in made:
        desk.close()


@pytest.fixture
def own(make_desk: Callable[[str], Desk]) -> Desk:
    """The same robot with a server and a page for one task alone."""
    return make_desk("S")


@pytest.fixture
def t(sit: Callable[..., Desk]) -> Desk:
    """A humanoid of 32 movable joints without meshes."""
    return sit("T")


@pytest.fixture
def c(sit: Callable[..., Desk]) -> Desk:
    """A chain of 300 joints."""
    return sit("C")


@pytest.fixture
def a(sit: Callable[..., Desk]) -> Desk:
    """An arm of five links with meshes."""
    return sit("A")


@pytest.fixture
def open_more(s: Desk) -> Iterator[Callable[..., ViewerPage]]:
    """Open one more page of the shared desk, closed with it."""
    yield from pages_of(s)


@pytest.fixture
def l(sit: Callable[..., Desk]) -> Desk:  # noqa: E743
    """A joint whose name has 56 letters, and a sliding joint."""
    return sit("L")
