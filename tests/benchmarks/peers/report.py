"""The results as tables in Markdown: all of them, and the short form of the README."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path

from tests.benchmarks.peers.checkers import Verdict
from tests.benchmarks.peers.measures import (
    INSTALLED,
    RECORDING_MEASURES,
    SHORT,
    VIEWER_MEASURES,
    Measure,
)
from tests.benchmarks.peers.peers import CANNOT_RUN, VIEWERS, Viewer
from tests.benchmarks.peers.results import Column, Columns, Results

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
"""What is between these lines of a document is written by a run."""


def lines(results: Results) -> Iterator[str]:
    """Every table, and what is not in them."""
    for robot, found in results.viewers.items():
        yield f"### {robot}\n"
        yield _when(results, robot) + "\n"
        yield from _viewer_table(found, results)
        yield ""
    yield from _notes(results)
    if results.checkers:
        yield "\n### Checking wrong models\n"
        yield _when(results, "checkers") + "\n"
        yield from _checker_table(results.checkers)
    if results.recordings:
        yield f"\n### A recording of {results.recording_size:.0f} MB\n"
        yield _when(results, "bags") + "\n"
        yield from _table(RECORDING_MEASURES, results.recordings)


def _when(results: Results, part: str) -> str:
    run = results.runs[part]
    return f"{run.date}, {run.machine}; it took {run.seconds / 60:.0f} minutes."


def _viewer_table(found: Columns, results: Results) -> Iterator[str]:
    yield from _table(VIEWER_MEASURES, found)
    hosts = [None if one.hosts is None else len(one.hosts) for one in found.values()]
    yield _row(
        "other hosts that the page asks",
        ["–" if count is None else str(count) for count in hosts],
    )
    yield _row(
        INSTALLED.title, [INSTALLED.text(results.sizes.get(name)) for name in found]
    )


def _table(measures: Sequence[Measure], found: Columns) -> Iterator[str]:
    """Medians with their spread, and their ratios to this program's."""
    yield from _head("", found)
    for measure in measures:
        best = _best(one.median(measure.key) for one in found.values())
        if best is not None:
            cells = [_cell(one, measure, best) for one in found.values()]
            yield _row(measure.title, cells)


def _best(values: Iterable[float | None]) -> float | None:
    return min((value for value in values if value is not None), default=None)


def _cell(column: Column, measure: Measure, best: float) -> str:
    spread = column.spreads.get(measure.key)
    if spread is None:
        return "–"
    text = measure.text(spread.median)
    if spread.half is not None:
        text += f" ± {measure.text(spread.half)}"
    if spread.ratio is not None and spread.ratio != 1.0:
        digits = ".2g" if spread.ratio < 10.0 else ",.0f"
        text += f" ({spread.ratio:{digits}}×)"
    return f"**{text}**" if spread.median <= best else text


def _checker_table(verdicts: Mapping[str, Verdict]) -> Iterator[str]:
    rows: list[tuple[str, Callable[[Verdict], str]]] = [
        ("noticed", lambda v: f"{v.noticed} of {v.cases}"),
        ("the line is named", lambda v: f"{v.lines} of {v.cases}"),
        ("ROS refuses it: ends with an error", lambda v: _of(v.refused)),
        ("ROS shows it: ends without an error", lambda v: _of(v.accepted)),
        ("hangs or crashes", lambda v: str(v.hangs)),
        ("complaints about right models", lambda v: f"{v.complaints} of {v.right}"),
        ("time of a check [s]", lambda v: f"{v.seconds:.2f}"),
    ]
    yield from _head("", verdicts)
    for title, cell in rows:
        yield _row(title, [cell(verdict) for verdict in verdicts.values()])


def _of(part: tuple[int, int]) -> str:
    return f"{part[0]} of {part[1]}"


def _notes(results: Results) -> Iterator[str]:
    for viewer in VIEWERS:
        if viewer.name in results.versions:
            yield _note(viewer, results)
    for name, reason in {**results.absent, **CANNOT_RUN}.items():
        yield f"- {name}: not measured: {reason}."


def _note(viewer: Viewer, results: Results) -> str:
    reasons: dict[str, list[str]] = {}
    for robot, found in results.viewers.items():
        if viewer.name in found:
            for why in dict.fromkeys(found[viewer.name].reasons.values()):
                reasons.setdefault(why, []).append(robot)
    words = [viewer.note] if viewer.note else []
    words += [f"{', '.join(where)}: {why}" for why, where in reasons.items()]
    end = f": {'; '.join(words)}" if words else ""
    return f"- {viewer.name} {results.versions[viewer.name]}{end}."


def short_table(results: Results) -> Iterator[str]:
    """What the README shows: some rows of one robot, for some viewers."""
    found = results.viewers.get(SHORT_ROBOT, {})
    shown = {name: found[name] for name in SHORT_VIEWERS if name in found}
    if not shown:
        return
    yield from _head("a robot of 50 joints", shown)
    for measure in VIEWER_MEASURES:
        if measure.key in SHORT:
            yield _plain_row(
                measure, [one.median(measure.key) for one in shown.values()]
            )
    yield _plain_row(INSTALLED, [results.sizes.get(name) for name in shown])


def _plain_row(measure: Measure, values: Sequence[float | None]) -> str:
    best = _best(values)
    cells = [(value, measure.text(value)) for value in values]
    return _row(
        measure.title,
        [f"**{text}**" if value == best else text for value, text in cells],
    )


def ahead(results: Results) -> Iterator[str]:
    """For every measure that a peer does better in, a line that names the best one."""
    for measure in VIEWER_MEASURES:
        words = [
            f"{best} {measure.text(theirs)} against {measure.text(ours)} ({robot})"
            for robot, found in results.viewers.items()
            for best, theirs, ours in _better(measure, found)
        ]
        if words:
            yield f"- {measure.title}: {'; '.join(words)}."


def _better(measure: Measure, found: Columns) -> Iterator[tuple[str, float, float]]:
    """The best peer, its value and ours, when it is better by more than a twentieth."""
    known = {
        name: median
        for name, one in found.items()
        if (median := one.median(measure.key)) is not None
    }
    ours = known.get(next(iter(found)))
    if ours is None:
        return
    best = min(known, key=lambda name: known[name])
    if known[best] < ours / 1.05:
        yield best, known[best], ours


def for_docs(results: Results) -> Iterator[str]:
    """What `docs/benchmarks.md` has between its lines."""
    yield from lines(results)
    behind = list(ahead(results))
    if behind:
        yield from ["", "### Where a peer is ahead", "", *behind]
    if results.growth:
        yield from ["", "### What a step costs the server", ""]
        if "growth" in results.runs:
            yield _when(results, "growth") + "\n"
        yield from (f"![{name}](benchmarks/{name}.svg)" for name in results.growth)


def write_docs(results: Results, repository: Path) -> None:
    """Bring the tables of the documents to these results."""
    for name, written in DOCUMENTS.items():
        path = repository / name
        document = with_figures(path.read_text("utf-8"), written(results))
        path.write_text(document, "utf-8")


DOCUMENTS: Mapping[str, Callable[[Results], Iterator[str]]] = {
    "README.md": short_table,
    "docs/benchmarks.md": for_docs,
}
"""Document → what it has between its lines."""


def with_figures(document: str, written: Iterable[str]) -> str:
    """A document with these lines between its two.

    Raises:
        ValueError: it does not have them.
    """
    before, found, rest = document.partition(BEGIN)
    _, ended, after = rest.partition(END)
    if not found or not ended:
        raise ValueError(f"no {BEGIN} and {END}")
    return before + "\n".join([BEGIN, "", *written, "", END]) + after


def _head(title: str, names: Mapping[str, object]) -> Iterator[str]:
    yield _row(title, list(names))
    yield _row("---", ["---:"] * len(names))


def _row(title: str, cells: Sequence[str]) -> str:
    return f"| {' | '.join([title, *cells])} |"
