"""Pages of a real Chromium: one for a test alone, or desks that tests share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from desk import Desk
    from viewer_page import ViewerPage

    from sambot_viz import Visualizer
    from sambot_viz.export.chromium import Chromium

_TASKS = Path(__file__).parent / "tasks"
_OUTPUT = Path(__file__).parents[1] / "output"
_FAILED = pytest.StashKey[bool]()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Iterator[None]:
    """Remember which tests failed: their desk is not used again."""
    outcome = yield
    report = outcome.get_result()  # type: ignore[attr-defined]
    if report.failed:
        item.stash[_FAILED] = True


@pytest.hookimpl(trylast=True)
def pytest_runtest_teardown(item: pytest.Item, nextitem: pytest.Item | None) -> None:
    """End the desks of a folder or file: open pages make the tests after it slower."""
    if nextitem is None or _home(nextitem) != _home(item):
        if desks := item.config.stash.get(_DESKS, None):
            desks.close()


def _home(item: pytest.Item) -> Path:
    """The file of a test; of a task, the folder."""
    return _TASKS if _TASKS in item.path.parents else item.path


@pytest.fixture
def view(request: pytest.FixtureRequest) -> bool:
    """Whether the pages of a test have a 3D view: they cost four times as much."""
    return request.node.get_closest_marker("view") is not None


@pytest.fixture
def open_viewer(chromium: Chromium, view: bool) -> Iterator[Callable[..., ViewerPage]]:
    """Open a viewer in a page of its own: ``open_viewer(url_or_port)``.

    The pages are closed at the end of the test. The test fails there when a page had
    an error or asked another server for anything, unless it set `expects_errors`. What
    looks at the scene, or reaches into it, has the mark `view`, or asks for view=True;
    what depends on the pixels that the view has before they are read asks for
    resolution=1.
    """
    yield from _viewers(chromium, view)


@pytest.fixture
def make_viz(make_viz: Callable[..., Visualizer]) -> Callable[..., Visualizer]:
    """The same in the look that is drawn sooner, where no other is asked for."""
    return partial(make_viz, look="rviz")


@pytest.fixture(scope="module")
def viz_for_all() -> Iterator[Visualizer]:
    """The bundled robot, for all tests of a file, each after the other."""
    from sambot_viz import Visualizer, bundled

    with Visualizer(bundled.model_path(), port=0, look="rviz") as viz:
        yield viz


@pytest.fixture(scope="module")
def open_for_all(chromium: Chromium) -> Iterator[Callable[..., ViewerPage]]:
    """The same for pages that all tests of a file use, each after the other."""
    yield from _viewers(chromium)


def _viewers(
    chromium: Chromium, in_test: bool = False
) -> Iterator[Callable[..., ViewerPage]]:
    from recorded_page import open_page
    from viewer_page import COARSE, ViewerPage, viewer_url

    viewers: list[ViewerPage] = []

    def open_one(
        address: str | int,
        *,
        width: int = 1280,
        height: int = 720,
        touch: bool = False,
        dark: bool = False,
        resolution: float = COARSE,
        view: bool = in_test,
    ) -> ViewerPage:
        page = open_page(chromium, width, height, touch=touch)
        page.set_dark(dark)
        url = viewer_url(address, resolution, view)
        page.goto(url)
        viewers.append(ViewerPage(page, url, touch, view))
        return viewers[-1]

    yield open_one
    for viewer in viewers:
        viewer.page.close()
    for viewer in viewers:
        assert viewer.foreign_requests() == []
        if not viewer.expects_errors:
            assert viewer.errors() == []


class Desks:
    """The desks that are open, by the letter of their robot and what they are for.

    Those with a view and those without are two.
    """

    def __init__(self, chromium: Chromium, folders: pytest.TempPathFactory) -> None:
        self._chromium = chromium
        self._folders = folders
        self._open: dict[tuple[str, bool], Desk] = {}

    def take(
        self, letter: str, config: str | None, resolution: float, view: bool
    ) -> Desk:
        """The desk with a robot, as it was at the start."""
        from desk import Desk

        if (letter, view) not in self._open:
            folder = self._folders.mktemp("desk")
            self._open[letter, view] = Desk(
                letter, self._chromium, folder, config, resolution, view
            )
        return self._open[letter, view]

    def drop(self, desk: Desk) -> None:
        """End a desk."""
        self._open = {key: one for key, one in self._open.items() if one is not desk}
        desk.close()

    def close(self) -> None:
        """End all."""
        for desk in list(self._open.values()):
            self.drop(desk)


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
    """Put what the page showed at the end of a failed test into tests/output."""
    _OUTPUT.mkdir(exist_ok=True)
    _OUTPUT.joinpath(f"{name}.png").write_bytes(desk.page.screenshot())


@pytest.fixture
def sit(
    desks: Desks, request: pytest.FixtureRequest, view: bool
) -> Iterator[Callable[..., Desk]]:
    """Use a desk that other tests use too: ``sit("S")``, ``sit("S near", config)``.

    What looks at the scene, or reaches into it, has the mark `view`.
    """
    from viewer_page import COARSE

    with ExitStack() as leaving:

        def at(
            letter: str, config: str | None = None, resolution: float = COARSE
        ) -> Desk:
            desk = desks.take(letter, config, resolution, view)
            leaving.callback(_leave, desks, desk, request)
            desk.viewer.sleep(False)
            return desk

        yield at


def _leave(desks: Desks, desk: Desk, request: pytest.FixtureRequest) -> None:
    """Tidy a desk for the next test, or end it when that would not be enough."""
    if request.node.stash.get(_FAILED, False):
        _keep_picture(desk, request.node.name)
        desks.drop(desk)
        return
    try:
        desk.tidy()
        assert desk.viewer.errors() == []
        assert desk.viewer.foreign_requests() == []
        desk.viewer.sleep()
    except BaseException:
        desks.drop(desk)
        raise
