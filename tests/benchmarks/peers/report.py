"""The results as JSON and as a table in Markdown, with ratios to this program."""

from __future__ import annotations

import json
import os
import platform
import statistics
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import date
from pathlib import Path
from typing import Any

from tests.benchmarks.peers.checkers import Verdict
from tests.benchmarks.peers.peers import CANNOT_RUN, VIEWERS, Viewer
from tests.benchmarks.peers.viewers import Found


@dataclass(frozen=True, slots=True)
class Measure:
    """A row of a table.

    Attributes:
        key: of the values.
        title: what it is, with its unit.
        scale: values times this are in that unit.
        digits: after the point.
    """

    key: str
    title: str
    scale: float = 1.0
    digits: int = 1


MEASURES = (
    Measure("page", "command → page opens [s]", digits=2),
    Measure("pixels", "command → first pixels of the robot [s]"),
    Measure("loaded", "reading the model [ms]", 1e3, 0),
    Measure("poses", "poses of all links [µs]", 1e6, 0),
    Measure("delay1", "a step → 1 client [ms]", 1e3),
    Measure("delay5", "a step → all of 5 clients [ms]", 1e3),
    Measure("delay30", "a step → all of 30 clients [ms]", 1e3),
    Measure("step_pixels", "a step → changed pixel [ms]", 1e3, 0),
    Measure("cpu_one", "computing of a step of one joint [ms]", digits=2),
    Measure("cpu_all", "computing of a step of all joints [ms]", digits=2),
    Measure("bytes_one", "bytes of a step of one joint", digits=0),
    Measure("bytes_all", "bytes of a step of all joints", digits=0),
    Measure("rest", "computing at rest [% of a core]"),
    Measure("rest_messages", "messages at rest [1/s]"),
    Measure("memory", "memory of the server [MB]", digits=0),
    Measure("memory_per_client", "memory per further client [MB]", digits=2),
    Measure("size", "what the page brings [MB]"),
)
SIZE = Measure("installed", "installed [MB]", digits=0)
BAG_MEASURES = (
    Measure("opening", "opening [ms]", 1e3),
    Measure("jump", "jump: last message of five topics [ms]", 1e3),
    Measure("peak", "most memory of both [MB]", digits=0),
    Measure("page", "command → address of the page [s]", digits=2),
    Measure("memory", "memory of the program [MB]", digits=0),
)


@dataclass(slots=True)
class Results:
    """All that one run has found.

    Attributes:
        viewers: by robot and name of the viewer.
        versions: of all peers.
        sizes: what each takes on the disk [MB].
        absent: peers that were not measured, with the reason.
        checkers: by name.
        bags: by name.
        bag_size: of the recording [MB].
        growth: by plot and line, the points (count, computing of a step [ms]).
        seconds: how long the run took.
    """

    viewers: dict[str, dict[str, Found]] = field(
        default_factory=dict[str, dict[str, Found]]
    )
    versions: dict[str, str] = field(default_factory=dict[str, str])
    sizes: dict[str, float] = field(default_factory=dict[str, float])
    absent: dict[str, str] = field(default_factory=dict[str, str])
    checkers: dict[str, Verdict] = field(default_factory=dict[str, Verdict])
    bags: dict[str, Found] = field(default_factory=dict[str, Found])
    bag_size: float = 0.0
    growth: dict[str, dict[str, list[tuple[float, float]]]] = field(
        default_factory=dict[str, dict[str, list[tuple[float, float]]]]
    )
    seconds: float = 0.0


def as_json(results: Results) -> str:
    """All values, with medians and spread."""
    table: dict[str, Any] = {
        "machine": machine(),
        "date": date.today().isoformat(),
        "seconds": round(results.seconds),
        "versions": results.versions,
        "installed_MB": results.sizes,
        "not_measured": {**results.absent, **CANNOT_RUN},
        "viewers": {
            robot: {name: _values(found) for name, found in by_name.items()}
            for robot, by_name in results.viewers.items()
        },
        "checkers": {n: asdict(verdict) for n, verdict in results.checkers.items()},
        "recording_MB": results.bag_size,
        "growth_ms": results.growth,
        "recordings": {name: _values(found) for name, found in results.bags.items()},
    }
    return json.dumps(table, indent=1, ensure_ascii=False)


def _values(found: Found) -> dict[str, Any]:
    return {
        **{
            key: {
                "median": statistics.median(values),
                "least": min(values),
                "most": max(values),
                "count": len(values),
            }
            for key, values in found.values.items()
        },
        "other_hosts": sorted(found.hosts),
        "not_measured": found.reasons,
    }


def machine() -> str:
    """What it ran on, without names."""
    return (
        f"{os.cpu_count()} cores, {platform.machine()}, {platform.system()}, "
        f"Python {platform.python_version()}, software WebGL"
    )


def as_markdown(results: Results) -> str:
    """The tables, and what is not in them."""
    return "\n".join(_lines(results)) + "\n"


def _lines(results: Results) -> Iterator[str]:
    yield f"Measured on {machine()}, in {results.seconds / 60:.0f} minutes."
    for robot, found in results.viewers.items():
        yield f"\n### {robot}\n"
        yield from viewer_table(found, results)
    yield from _notes(results)
    if results.checkers:
        yield "\n### Checking wrong models\n"
        yield from checker_table(results.checkers)
    if results.bags:
        yield f"\n### A recording of {results.bag_size:.0f} MB\n"
        yield from table(BAG_MEASURES, results.bags)


def viewer_table(found: Mapping[str, Found], results: Results) -> Iterator[str]:
    """One column a viewer; the best of each row is bold."""
    hosts = {
        n: str(len(f.hosts)) if f.values.get("size") else "–" for n, f in found.items()
    }
    sizes = {n: f"{results.sizes[n]:.0f}" if n in results.sizes else "–" for n in found}
    yield from table(MEASURES, found)
    yield _row("other hosts that the page asks", list(hosts.values()))
    yield _row("installed [MB]", list(sizes.values()))


def table(measures: Sequence[Measure], found: Mapping[str, Found]) -> Iterator[str]:
    """Medians with their spread; ratios to the first column, which is ours."""
    names = list(found)
    yield _row("", names)
    yield _row("---", ["---:"] * len(names))
    for measure in measures:
        medians = [found[name].median(measure.key) for name in names]
        known = [value for value in medians if value is not None]
        if not known:
            continue
        ours = medians[0]
        cells = [
            _cell(found[name], measure, ours if number else None, min(known))
            for number, name in enumerate(names)
        ]
        yield _row(measure.title, cells)


def _cell(found: Found, measure: Measure, ours: float | None, best: float) -> str:
    values = found.values.get(measure.key)
    if not values:
        return "–"
    median = statistics.median(values)
    text = f"{median * measure.scale:,.{measure.digits}f}"
    if len(values) > 2:
        half = _half_spread(values) * measure.scale
        text += f" ± {half:,.{measure.digits}f}"
    if ours is not None and ours > 0.0:
        text += f" ({median / ours:.2g}×)"
    return f"**{text}**" if median <= best else text


def _half_spread(values: Sequence[float]) -> float:
    """Half the distance between the quarters."""
    quarters = statistics.quantiles(values, n=4)
    return (quarters[2] - quarters[0]) / 2


def checker_table(verdicts: Mapping[str, Verdict]) -> Iterator[str]:
    """One column a checker."""
    names, found = list(verdicts), list(verdicts.values())
    rows: list[tuple[str, Callable[[Verdict], str]]] = [
        ("ROS refuses: refused", lambda v: f"{v.refused} of {v.cases[0]}"),
        ("ROS accepts: noticed", lambda v: f"{v.noticed} of {v.cases[1]}"),
        ("the line is named", lambda v: f"{v.lines} of {sum(v.cases)}"),
        ("hangs or crashes", lambda v: str(v.hangs)),
        ("complaints about right models", lambda v: f"{v.complaints} of {v.right}"),
        ("time of a check [s]", lambda v: f"{v.seconds:.2f}"),
    ]
    yield _row("", names)
    yield _row("---", ["---:"] * len(names))
    for title, cell in rows:
        yield _row(title, [cell(verdict) for verdict in found])


def _notes(results: Results) -> Iterator[str]:
    yield ""
    for viewer in VIEWERS:
        if viewer.name in results.versions:
            yield _note(viewer, results)
    for name, reason in {**results.absent, **CANNOT_RUN}.items():
        yield f"- {name}: not measured: {reason}."


def _note(viewer: Viewer, results: Results) -> str:
    reasons: dict[str, list[str]] = {}
    for robot, found in results.viewers.items():
        if viewer.name in found:
            for why in found[viewer.name].reasons.values():
                reasons.setdefault(why, []).append(robot)
    words = [viewer.note] if viewer.note else []
    words += [f"{', '.join(where)}: {why}" for why, where in reasons.items()]
    end = f": {'; '.join(words)}" if words else ""
    return f"- {viewer.name} {results.versions[viewer.name]}{end}."


def _row(title: str, cells: Sequence[str]) -> str:
    return f"| {' | '.join([title, *cells])} |"


SHORT = ("page", "pixels", "delay30", "cpu_one", "bytes_one", "rest", "memory")
SHORT_ROBOT = "tree50"
SHORT_VIEWERS = (
    "sambot-viz",
    "viser ViserUrdf",
    "MeshCat + Pinocchio",
    "Drake ModelVisualizer",
    "rerun web viewer",
    "RViz (ROS 1)",
)
"""What the README has room for."""
BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def short_table(results: Results) -> Iterator[str]:
    """What the README shows: some rows of one robot, and where others are ahead."""
    found = results.viewers[SHORT_ROBOT]
    names = [name for name in SHORT_VIEWERS if name in found]
    rows = [measure for measure in MEASURES if measure.key in SHORT]
    yield _row("a robot of 50 joints", names)
    yield _row("---", ["---:"] * len(names))
    for measure in rows:
        cells = [_plain(found[name].median(measure.key), measure) for name in names]
        yield _row(measure.title, cells)
    sizes = [_plain(results.sizes.get(name), SIZE) for name in names]
    yield _row("installed [MB]", sizes)


def _plain(median: float | None, measure: Measure) -> str:
    if median is None:
        return "–"
    return f"{median * measure.scale:,.{measure.digits}f}"


def ahead(results: Results) -> Iterator[str]:
    """For every measure that a peer does better in, a line that names the best one."""
    for measure in MEASURES:
        words: list[str] = []
        for robot, found in results.viewers.items():
            ours = next(iter(found.values())).median(measure.key)
            known = {n: m for n, f in found.items() if (m := f.median(measure.key))}
            if not ours or not known:
                continue
            best = min(known, key=lambda name: known[name])
            if known[best] < ours / 1.05:
                words.append(
                    f"{best} {_plain(known[best], measure)} against "
                    f"{_plain(ours, measure)} ({robot})"
                )
        if words:
            yield f"- {measure.title}: {'; '.join(words)}."


def write_docs(results: Results, repository: Path) -> None:
    """Bring the figures of the README and of `docs/benchmarks.md` to this run's."""
    plots = [f"![{name}](benchmarks/{name}.svg)" for name in results.growth]
    behind = ["", "### Where a peer is ahead", "", *ahead(results)]
    growth = ["", "### What a step costs the server", "", *plots] if plots else []
    whole = [*_lines(results), *behind, *growth]
    _replace(repository / "docs" / "benchmarks.md", whole)
    _replace(repository / "README.md", list(short_table(results)))


def _replace(path: Path, lines: Sequence[str]) -> None:
    before, found, rest = path.read_text("utf-8").partition(BEGIN)
    if not found:
        return
    _, _, after = rest.partition(END)
    text = "\n".join([BEGIN, "", *lines, "", END])
    path.write_text(before + text + after, "utf-8")


def write(results: Results, folder: Path) -> None:
    """Write `benchmarks.json` and `benchmarks.md`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "benchmarks.json").write_text(as_json(results) + "\n", "utf-8")
    (folder / "benchmarks.md").write_text(as_markdown(results), "utf-8")
