"""Measure this program beside its peers: ``python -m tests.benchmarks``.

Run it from the repository with the Python of the tests. Every peer gets an environment
of its own below ``tests/.venv/peers``, made once; one that cannot be had is left out,
with the reason. The results are written as JSON and as tables in Markdown.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tests" / "support"))

import large_recording  # noqa: E402
from tests.benchmarks.peers import (  # noqa: E402
    bags,
    checkers,
    environments,
    growth,
    peers,
    regression,
    report,
    results,
    robots,
    viewers,
)
from tests.benchmarks.peers.environments import Environment, NotHere  # noqa: E402
from tests.benchmarks.peers.results import Results  # noqa: E402

from sambot_viz.export.browser_process import find_browser  # noqa: E402
from sambot_viz.export.chromium import Chromium  # noqa: E402

ROBOTS = ("sam_bot", "tree50", "tree300", "meshes12")
PARTS = ("viewers", "checkers", "bags", "growth")


def parser() -> argparse.ArgumentParser:
    """What the command line has."""
    made = argparse.ArgumentParser(
        prog="python -m tests.benchmarks", description=__doc__
    )
    made.add_argument(
        "--short",
        action="store_true",
        help="only judge ratios to ViserUrdf, within a minute; exit status 1 when one "
        "is above its limit",
    )
    made.add_argument("--out", type=Path, default=Path("benchmarks"), metavar="FOLDER")
    made.add_argument(
        "--docs",
        action="store_true",
        help="bring the figures in docs/ and README.md to this run's; parts and robots "
        "that are not measured keep theirs",
    )
    made.add_argument(
        "--parts", nargs="+", choices=PARTS, default=PARTS, help="what is measured"
    )
    made.add_argument(
        "--viewers",
        nargs="+",
        metavar="NAME",
        choices=[viewer.driver for viewer in peers.VIEWERS],
        help=f"of {', '.join(v.driver for v in peers.VIEWERS)}",
    )
    made.add_argument("--robots", nargs="+", choices=ROBOTS, default=ROBOTS)
    made.add_argument(
        "--rounds", type=int, default=3, help="starts of each viewer (default: 3)"
    )
    made.add_argument(
        "--recording", type=int, default=1000, metavar="MB", help="its size"
    )
    return made


def main(words: Sequence[str] | None = None) -> int:
    """Measure, and write the results."""
    made = parser()
    options = made.parse_args(words)
    if options.docs and options.viewers:
        made.error("--docs needs all viewers: their columns are compared")
    if options.short:
        return _short()
    out = REPOSITORY / "docs" / "benchmarks" if options.docs else options.out
    kept = out / "benchmarks.json"
    found = results.read(kept) if options.docs else Results()
    with tempfile.TemporaryDirectory() as folder:
        if "viewers" in options.parts:
            _viewers(options, Path(folder), found)
        if "checkers" in options.parts:
            _checkers(Path(folder), found)
        if "bags" in options.parts:
            _bags(options.recording, Path(folder), found)
        if "growth" in options.parts:
            _growth(Path(folder), out, found)
    results.write(found, kept)
    tables = "\n".join(report.lines(found)) + "\n"
    if options.docs:
        report.write_docs(found, REPOSITORY)
    else:
        (out / "benchmarks.md").write_text(tables, "utf-8")
    print(tables)
    return 0


def _say(*words: object) -> None:
    print(*words, file=sys.stderr, flush=True)


def _short() -> int:
    with tempfile.TemporaryDirectory() as folder:
        model = robots.write(Path(folder), REPOSITORY)["tree50"]
        return 0 if regression.run(model, _say) else 1


def _viewers(options: argparse.Namespace, folder: Path, kept: Results) -> None:
    made = robots.write(folder, REPOSITORY)
    here = _environments(options.viewers, kept)
    browser: AbstractContextManager[Chromium | None] = nullcontext()
    if find_browser() is None:
        kept.absent["pixels of all viewers"] = "there is no Chromium here"
    else:
        browser = Chromium(timeout=120.0)
    with browser as window:
        for name in options.robots:
            began = time.monotonic()
            found = {viewer.name: viewers.Found() for viewer in here}
            # In turn, so that what else the machine does meets all of them.
            for number in range(options.rounds):
                for viewer, place in here.items():
                    _say(f"{name}: start {number + 1} of {viewer.name}")
                    one = found[viewer.name]
                    start = partial(viewers.measure_start, viewer, place, made[name])
                    one.attempt("start", partial(start, window, one))
            for viewer, place in here.items():
                _say(f"{name}: {viewer.name} moves")
                one = found[viewer.name]
                move = partial(viewers.measure_moving, viewer, place, made[name])
                one.attempt("moving", partial(move, one))
            kept.viewers[name] = results.columns(found)
            kept.ran(name, time.monotonic() - began)


def _environments(
    chosen: Sequence[str] | None, kept: Results
) -> dict[peers.Viewer, Environment]:
    here: dict[peers.Viewer, Environment] = {}
    for viewer in peers.VIEWERS:
        if chosen and viewer.driver not in chosen:
            continue
        _say(f"environment of {viewer.name}")
        for of_before in (kept.versions, kept.sizes, kept.absent):
            of_before.pop(viewer.name, None)
        try:
            here[viewer] = _environment(viewer)
        except NotHere as error:
            kept.absent[viewer.name] = str(error)
            continue
        kept.versions[viewer.name] = here[viewer].version
        if here[viewer].size:
            kept.sizes[viewer.name] = here[viewer].size
    return here


def _environment(viewer: peers.Viewer) -> Environment:
    folder = viewers.folder_of(REPOSITORY)
    if viewer.is_ours:
        return environments.own(REPOSITORY, folder)
    if viewer.debian:
        return environments.debian(viewer.debian)
    return environments.prepare(
        folder, viewer.driver, viewer.packages, viewer.modules, viewer.version_of
    )


def _checkers(folder: Path, kept: Results) -> None:
    began = time.monotonic()
    wrong, spare = folder / "wrong", folder / "reports"
    for one in (wrong, spare):
        one.mkdir()
    cases = list(checkers.own_cases(wrong))
    beside = REPOSITORY.parent / "shared" / "data" / "bad-models" / "index.yaml"
    right = [robots.write(wrong, REPOSITORY)["tree50"].path]
    if beside.is_file():
        cases += checkers.further_cases(beside)
        right.append(beside.with_name("_good.urdf"))
    kept.checkers.clear()
    for checker in peers.CHECKERS:
        _say(f"checks with {checker.name}")
        try:
            program = _checker_program(checker)
        except NotHere as error:
            kept.absent[checker.name] = str(error)
            continue
        kept.absent.pop(checker.name, None)
        kept.checkers[checker.name] = checkers.judge(
            checker, program, cases, right, spare
        )
    kept.ran("checkers", time.monotonic() - began)


def _checker_program(checker: peers.Checker) -> Path:
    if checker.debian:
        found = shutil.which(checker.command[0])
        if found is None:
            raise NotHere(f"install Debian's package {checker.debian}")
        return Path(found)
    if not checker.packages:
        return checkers.own_program()
    place = environments.prepare(
        viewers.folder_of(REPOSITORY),
        checker.command[0],
        checker.packages,
        (),
        checker.packages[0],
    )
    return place.program(checker.command[0])


def _bags(size: int, folder: Path, kept: Results) -> None:
    began = time.monotonic()
    recording = folder / "recording.mcap"
    _say(f"writes a recording of {size} MB")
    large_recording.write(recording, size * 1_000_000)
    kept.recording_size = recording.stat().st_size / 1e6
    found: dict[str, viewers.Found] = {}
    for name, ours in (("sambot-viz", True), ("mcap (Python)", False)):
        one = found.setdefault(name, viewers.Found())
        for _ in range(3):
            one.attempt("library", partial(bags.measure_library, ours, recording, one))
    here = _environments(["this_program", "rerun_web"], kept)
    for viewer, place in here.items():
        name = "sambot-viz" if viewer.is_ours else "rerun"
        one = found.setdefault(name, viewers.Found())
        for _ in range(3):
            _say(f"{name} opens the recording")
            one.attempt(
                "program", partial(bags.measure_program, name, place, recording, one)
            )
    kept.recordings = results.columns(found)
    kept.ran("bags", time.monotonic() - began)


def _growth(folder: Path, out: Path, kept: Results) -> None:
    began = time.monotonic()
    kept.growth.clear()
    for plot in growth.measure(folder, _say):
        kept.growth[plot.name] = plot.lines
        try:
            growth.draw(plot, out)
        except ImportError:
            kept.absent["plots"] = "pip install matplotlib"
    kept.ran("growth", time.monotonic() - began)


if __name__ == "__main__":
    sys.exit(main())
