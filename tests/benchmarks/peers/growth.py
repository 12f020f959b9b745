"""How the cost of a step grows: with joints, links, frames and browsers.

Computing of the server is measured, beside viser's ViserUrdf where it has the same.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from tests.benchmarks.peers import robots, viewers
from tests.benchmarks.peers.driven import NotMeasured, drive
from tests.benchmarks.peers.environments import Environment
from tests.benchmarks.peers.peers import OURS, VISER_URDF, Viewer
from tests.benchmarks.peers.robots import Model
from tests.benchmarks.peers.viewers import Found
from tests.benchmarks.peers.watchers import watching

SIZES = (10, 50, 100, 200, 300)
BROWSERS = (1, 5, 10, 20, 30)
FRAMES = """Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/RobotModel, Name: Robot, Enabled: true}
    - {Class: rviz_default_plugins/TF, Name: TF, Enabled: true, Show Names: true}
  Global Options: {Fixed Frame: l0}
"""
"""A config that shows every frame with its name."""
Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Growth:
    """A plot.

    Attributes:
        name: of its file.
        title: what grows.
        axis: of what is counted.
        lines: by name, the points (count, computing of a step [ms]).
    """

    name: str
    title: str
    axis: str
    lines: dict[str, list[Point]]


def measure(folder: Path, say: Callable[[str], object]) -> Iterator[Growth]:
    """Measure all plots, one after the other."""
    trees = {count: robots.tree(folder, f"grow{count}", count) for count in SIZES}
    here = Environment(Path(sys.executable), None, "", 0.0)
    config = folder / "frames.rviz"
    config.write_text(FRAMES, "utf-8")

    def line(viewer: Viewer, moved: str, models: dict[int, Model]) -> list[Point]:
        found: list[Point] = []
        for count, model in models.items():
            say(f"growth: {viewer.name}, {count}")
            found += _point(viewer, here, model, moved, count)
        return found

    both = (OURS, VISER_URDF)
    yield Growth(
        "joints",
        "one of so many joints moves, or all of them",
        "joints",
        {
            f"{viewer.name}, {moved}": line(viewer, moved, trees)
            for viewer in both
            for moved in ("one", "all")
        },
    )
    behind = {count: robots.behind_one(folder, count) for count in SIZES}
    yield Growth(
        "links",
        "one joint moves so many links behind it",
        "links",
        {viewer.name: line(viewer, "one", behind) for viewer in both},
    )
    shown = {count: _with(config, model) for count, model in trees.items()}
    yield Growth(
        "frames",
        "one joint moves while so many frames are shown with their names",
        "frames",
        {OURS.name: line(OURS, "one", shown)},
    )
    yield Growth(
        "browsers",
        "one of 50 joints moves in so many browsers",
        "browsers",
        {viewer.name: _browsers(viewer, here, trees[50], say) for viewer in both},
    )


def _with(config: Path, model: Model) -> Model:
    return Model(model.name, model.path, model.colour, config)


def _point(
    viewer: Viewer, here: Environment, model: Model, moved: str, count: int
) -> list[Point]:
    found = Found()
    try:
        with drive(viewer, here, model) as driven:
            viewers.cost(driven, None, moved, 1 if moved == "one" else 10_000, found)
    except NotMeasured:
        return []
    return [(count, found.values[f"cpu_{moved}"][0])]


def _browsers(
    viewer: Viewer, here: Environment, model: Model, say: Callable[[str], object]
) -> list[Point]:
    points: list[Point] = []
    with drive(viewer, here, model) as driven:
        for count in BROWSERS:
            say(f"growth: {viewer.name}, {count} browsers")
            with watching(*viewers.socket_of(viewer, driven), count) as clients:
                found = Found()
                viewers.cost(driven, clients, "one", 1, found)
                points.append((count, found.values["cpu_one"][0]))
    return points


def draw(growth: Growth, folder: Path) -> Path:
    """Write a plot as SVG.

    Raises:
        ImportError: matplotlib is not installed.
    """
    import matplotlib

    matplotlib.use("svg")
    # The same figures give the same file.
    matplotlib.rcParams["svg.hashsalt"] = growth.name
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5.5, 3.2), layout="constrained")
    for name, points in growth.lines.items():
        axes.plot(*zip(*points, strict=True), marker="o", label=name)
    axes.set_title(growth.title, fontsize=10)
    axes.set_xlabel(growth.axis)
    axes.set_ylabel("computing of a step [ms]")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)
    path = folder / f"{growth.name}.svg"
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    return path
