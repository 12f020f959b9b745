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

    from sambot_viz.export.chromium import Chromium

_HERE = Path(__file__).parent
_OUTPUT = _HERE.parents[1] / "output"
_FAILED = pytest.StashKey[bool]()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Shuffle the tasks among their own places: none may depend on another."""
    places = [n for n, item in enumerate(items) if _HERE in item.path.parents]
    tasks = [items[n] for n in places]
    random.Random(int(os.environ["SAMBOT_VIZ_TASK_SEED"])).shuffle(tasks)
    for place, task in zip(places, tasks, strict=True):
        items[place] = task


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Iterator[None]:
    """Remember which tasks failed: their desk is not used again."""
    outcome = yield
    report = outcome.get_result()  # type: ignore[attr-defined]
    if report.failed:
        item.stash[_FAILED] = True


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """End the desks after the last task: open pages make the tests after it slower."""
    if nextitem is None or _HERE not in nextitem.path.parents:
        if desks := item.config.stash.get(_DESKS, None):
            desks.close()


class Desks:
    """The desks that are open, by the letter of their robot."""

    def __init__(self, chromium: Chromium, folders: pytest.TempPathFactory) -> None:
        self._chromium = chromium
        self._folders = folders
        self._open: dict[str, Desk] = {}

    def take(self, letter: str) -> Desk:
        """The desk with a robot, as it was at the start."""
        from desk import Desk

        if letter not in self._open:
            folder = self._folders.mktemp(letter.replace(" ", "-"))
            self._open[letter] = Desk(letter, self._chromium, folder)
        return self._open[letter]

    def drop(self, letter: str) -> None:
        """End a desk."""
        desk = self._open.pop(letter, None)
        if desk is not None:
            desk.close()

    def close(self) -> None:
        """End all."""
        for letter in list(self._open):
            self.drop(letter)


_DESKS = pytest.StashKey[Desks]()


@pytest.fixture(scope="session")
def desks(
    chromium: Chromium,
    tmp_path_factory: pytest.TempPathFactory,
    request: pytest.FixtureRequest,
) -> Iterator[Desks]:
    """The desks; a robot's server and page start with its first task."""
    desks = request.config.stash[_DESKS] = Desks(chromium, tmp_path_factory)
    yield desks
    desks.close()


def _keep_picture(desk: Desk, name: str) -> None:
    """Put what the page showed at the end of a failed task into tests/output."""
    _OUTPUT.mkdir(exist_ok=True)
    _OUTPUT.joinpath(f"{name}.png").write_bytes(desk.page.screenshot())


def _desk(desks: Desks, letter: str, request: pytest.FixtureRequest) -> Iterator[Desk]:
    desk = desks.take(letter)
    yield desk
    if request.node.stash.get(_FAILED, False):
        _keep_picture(desk, request.node.name)
        desks.drop(letter)
        return
    try:
        desk.tidy()
        assert desk.viewer.errors() == []
        assert desk.viewer.foreign_requests() == []
    except BaseException:
        desks.drop(letter)
        raise


@pytest.fixture
def s(desks: Desks, request: pytest.FixtureRequest) -> Iterator[Desk]:
    """The small two-wheeled robot that comes with the program."""
    yield from _desk(desks, "S", request)


@pytest.fixture
def files(desks: Desks, request: pytest.FixtureRequest) -> Iterator[Desk]:
    """The same robot, for tasks that open and save configs."""
    yield from _desk(desks, "S files", request)


@pytest.fixture
def make_desk(chromium: Chromium, tmp_path: Path) -> Iterator[Callable[[str], Desk]]:
    """A desk for one task alone: ``make_desk("S")``, or with the text of a model."""
    from desk import Desk

    made: list[Desk] = []

    def make(letter: str) -> Desk:
        made.append(Desk(letter, chromium, tmp_path / f"desk{len(made)}"))
        return made[-1]

    yield make
    for desk in made:
        desk.close()


@pytest.fixture
def own(make_desk: Callable[[str], Desk]) -> Desk:
    """The same robot with a server and a page for one task alone."""
    return make_desk("S")


@pytest.fixture
def t(desks: Desks, request: pytest.FixtureRequest) -> Iterator[Desk]:
    """A humanoid of 32 movable joints without meshes."""
    yield from _desk(desks, "T", request)


@pytest.fixture
def c(desks: Desks, request: pytest.FixtureRequest) -> Iterator[Desk]:
    """A chain of 300 joints."""
    yield from _desk(desks, "C", request)


@pytest.fixture
def l(desks: Desks, request: pytest.FixtureRequest) -> Iterator[Desk]:  # noqa: E743
    """A joint whose name has 56 letters, and a sliding joint."""
    yield from _desk(desks, "L", request)
