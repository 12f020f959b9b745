"""What is measured of a viewer that shows a robot."""

from __future__ import annotations

import itertools
import statistics
import time
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from urllib.parse import urlsplit

from tests.benchmarks.peers.driven import Driven, NotMeasured, drive
from tests.benchmarks.peers.environments import Environment
from tests.benchmarks.peers.peers import Viewer
from tests.benchmarks.peers.picture import Watched
from tests.benchmarks.peers.robots import Model
from tests.benchmarks.peers.watchers import Frame, Watchers, watching
from usage import Usage

from sambot_viz.export.chromium import Chromium
from sambot_viz.export.devtools import BrowserError
from sambot_viz.server.channel import SUBPROTOCOL

CLIENTS = (1, 5, 30)
RATE = 10.0
"""Steps in a second; a step has all its frames before the next one begins [Hz]."""
STEPS = 20
FAST = 30.0
"""The rate for computing [Hz]."""
SLOW = 4.0
"""The rate for bytes: where steps overtake each other, some are never sent [Hz]."""
PAUSE = 0.06
"""After a step, for its last frames, where a viewer needs longer for it [s]."""
REST = 3.0
"""How long nothing is done [s]."""
LONGEST = 60.0


@dataclass(slots=True)
class Found:
    """The values of one viewer and one robot, by measure; and why some have none."""

    values: dict[str, list[float]] = field(default_factory=dict[str, list[float]])
    hosts: set[str] = field(default_factory=set[str])
    reasons: dict[str, str] = field(default_factory=dict[str, str])

    def add(self, measure: str, *values: float) -> None:
        """Keep further values of a measure."""
        self.values.setdefault(measure, []).extend(values)

    def median(self, measure: str) -> float | None:
        """The middle one; None when there is none."""
        values = self.values.get(measure)
        return statistics.median(values) if values else None

    def attempt(self, name: str, measure: Callable[[], object]) -> None:
        """Measure; one that fails is remembered with its reason."""
        try:
            measure()
        except (NotMeasured, BrowserError, OSError) as error:
            self.reasons[name] = str(error).partition("\n")[0][:160]


def measure_start(
    viewer: Viewer,
    environment: Environment,
    model: Model,
    browser: Chromium | None,
    found: Found,
) -> None:
    """From the command to the page and to the first pixels; and what the page brings.

    Raises:
        NotMeasured: the viewer does not show the robot.
    """
    began = time.time()
    with drive(viewer, environment, model) as driven:
        if not driven.url:
            found.attempt("pixels", lambda: _window(driven, model, began, found))
            return
        _read_page(driven.url)
        found.add("page", time.time() - began)
        if driven.said.get("loaded") is not None:
            found.add("loaded", float(driven.said["loaded"]))
        if browser is not None:
            found.attempt(
                "pixels", lambda: _picture(driven, model, browser, began, found)
            )


def _window(driven: Driven, model: Model, began: float, found: Found) -> None:
    found.add("pixels", driven.ask(do="robot_at")["clock"] - began)
    time.sleep(2.0)
    for number in range(1, 4 if model.name != "sam_bot" else 1):
        found.add("step_pixels", driven.ask(do="changed", value=0.3 * number)["took"])
        time.sleep(0.5)


def _read_page(url: str) -> None:
    end = time.perf_counter() + LONGEST
    while time.perf_counter() < end:
        try:
            with urllib.request.urlopen(url.partition("#")[0], timeout=10.0) as page:
                page.read(1)
            return
        except urllib.error.URLError:
            time.sleep(0.01)
    raise NotMeasured("its page does not open")


def _picture(
    driven: Driven, model: Model, browser: Chromium, began: float, found: Found
) -> None:
    page = Watched(browser, model.colour)
    try:
        page.goto(driven.url)
        found.add("pixels", page.robot_at() - began)
        found.attempt("rest of the picture", page.settle)
        weight = page.weight(driven.url)
        found.add("size", weight.size)
        found.hosts |= set(weight.hosts)
        # Wheels that turn look as before: their pixels say nothing.
        if model.name == "sam_bot" or not driven.said["moves"]:
            return
        for number in range(1, 4):
            at = driven.ask(do="move", joints=1, value=0.3 * number)["clock"]
            found.add("step_pixels", page.changed_after(at) - at)
            page.settle(0.5)
    finally:
        page.close()


def measure_moving(
    viewer: Viewer, environment: Environment, model: Model, found: Found
) -> None:
    """What a step costs, how late and how large it is, and what rest costs.

    Raises:
        NotMeasured: the viewer does not show the robot, or cannot be told to move it.
    """
    with drive(viewer, environment, model) as driven:
        if driven.said["poses"]:
            each = float(driven.ask(do="poses", times=20)["each"])
            found.add("poses", each)
        if not driven.said["moves"]:
            raise NotMeasured("only its own page moves the robot")
        if not viewer.websocket:
            _rest(driven, found)
            cost(driven, None, "one", 1, found)
            cost(driven, None, "all", 10_000, found)
            return
        first: Usage | None = None
        for count in CLIENTS:
            with watching(*socket_of(viewer, driven), count) as clients:
                load = driven.load()
                if first is None:
                    first = load
                    _alone(driven, clients, found)
                elif count == CLIENTS[-1]:
                    per = (load.memory - first.memory) / (count - CLIENTS[0])
                    found.add("memory_per_client", per)
                found.attempt(
                    f"delay{count}", partial(_add_delays, count, driven, clients, found)
                )


def socket_of(viewer: Viewer, driven: Driven) -> tuple[str, list[str | None]]:
    place = urlsplit(driven.url)
    address = f"ws://{place.hostname}:{place.port}{viewer.socket_path}"
    first = driven.said.get("subprotocol")
    if viewer.is_ours:
        import viser

        return address, [f"viser-v{viser.__version__}", SUBPROTOCOL]
    return address, [None if first is None else str(first)]


def _alone(driven: Driven, clients: Watchers, found: Found) -> None:
    """What is measured with one client."""
    _rest(driven, found)
    found.add("rest_messages", len(clients.seen()[0]) / REST)
    cost(driven, clients, "one", 1, found)
    cost(driven, clients, "all", 10_000, found)


def _rest(driven: Driven, found: Found) -> None:
    """What it takes when nothing moves."""
    before = driven.load()
    time.sleep(REST)
    after = driven.load()
    found.add("rest", 100.0 * after.share_since(before))
    found.add("memory", after.memory)


def cost(
    driven: Driven, clients: Watchers | None, name: str, joints: int, found: Found
) -> None:
    """Computing and bytes of a step of one joint or of all."""
    steps = 3 * STEPS
    driven.ask(do="pace", joints=joints, rate=FAST, steps=5)
    before = driven.load()
    driven.ask(do="pace", joints=joints, rate=FAST, steps=steps)
    found.add(f"cpu_{name}", 1000.0 * (driven.load().cpu - before.cpu) / steps)
    if clients is not None:
        clients.seen()
        steps = STEPS // 2
        driven.ask(do="pace", joints=joints, rate=SLOW, steps=steps, pause=PAUSE)
        frames = clients.seen()[0]
        found.add(f"bytes_{name}", sum(size for _, size in frames) / steps)


def _add_delays(count: int, driven: Driven, clients: Watchers, found: Found) -> None:
    found.add(f"delay{count}", *_delays(driven, clients))


def _delays(driven: Driven, clients: Watchers) -> list[float]:
    """How long each step took until the last client had its last frame [s]."""
    steps = driven.ask(do="pace", joints=1, rate=RATE, steps=STEPS, pause=PAUSE)
    times: list[float] = steps["at"]
    seen = clients.seen()
    late = [_of_steps(times, frames) for frames in seen]
    found = [max(of) for of in zip(*late, strict=True)]
    # On a busy machine some arrive together with the next one.
    alone = [value for value in found if value < float("inf")]
    if 2 * len(alone) < len(found):
        raise NotMeasured("most steps do not reach every client by themselves")
    return alone


def _of_steps(times: list[float], frames: list[Frame]) -> Iterator[float]:
    stamps = sorted(at for at, _ in frames if at)
    for start, end in itertools.pairwise([*times, float("inf")]):
        own = [at for at in stamps if start < at < end]
        yield own[-1] - start if own else float("inf")


def folder_of(repository: Path) -> Path:
    """Where the environments of all peers are kept."""
    return repository / "tests" / ".venv" / "peers"
