"""What `check` says of many models and packages, stored to be compared.

    python tests/support/oracle.py                   what differs from what is stored
    python tests/support/oracle.py --write           store the findings of today
    python tests/support/oracle.py --write samples   of this corpus alone

There is one file for each corpus in tests/data/oracle, with a line for each finding
and its edits.
A change of `check` leaves these files as they are, or its commit has their new lines,
each of which is better than the old one. Models of the collection ../shared are read
where they are: only what is said of them is stored.
"""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from difflib import unified_diff
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

from problem_samples import all_samples
from quick_yaml import quick_yaml
from real_robots import real_robots
from xacro_memory import XacroMemory

from sambot_viz import bundled
from sambot_viz.checks import check
from sambot_viz.checks.checked import check_all
from sambot_viz.checks.model.mesh_files import MeshFiles
from sambot_viz.edits import source_of
from sambot_viz.errors import Problem, UsageError
from sambot_viz.robot.packages.package_model import MODEL_ENDINGS

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
STORED = ROOT / "tests" / "data" / "oracle"

Findings = dict[str, list[str]]
"""Name of an input → its findings, a line each."""

_KEPT = ("PATH", "SYSTEMROOT", "TMPDIR", "LANG")
"""Other variables of the environment may lead to packages of this machine."""
_SEARCHED = re.compile(r"\((looked in|searched:) [^()]*\)")
"""The folders in which a package was looked for go up to the root of the machine."""


@dataclass(frozen=True, slots=True)
class Input:
    """A model or a package that is checked.

    Attributes:
        name: what it is called in the stored file.
        check: checks it.
        folder: places are told from here.
        known: findings that are left out, wherever they are; see `_told`.
        files: file → its text, of files that are not on the disk any more.
    """

    name: str
    check: Callable[[], list[Problem]]
    folder: Path | None = None
    known: frozenset[str] = frozenset()
    files: Mapping[str, str | bytes] = field(default_factory=dict[str, "str | bytes"])


@dataclass(frozen=True, slots=True)
class Corpus:
    """Models and packages of one kind.

    Attributes:
        name: that of the stored file.
        inputs: finds them, given a folder to write to; each is checked before the next.
        in_shared: they are in the collection ../shared.
        every: each so manieth is checked in every run, the others with the slow tests.
    """

    name: str
    inputs: Callable[[Path], Iterator[Input]]
    in_shared: bool = False
    every: int = 1

    @property
    def file(self) -> Path:
        """Where its findings are stored."""
        return STORED / f"{self.name}.json"

    def stored(self) -> Findings:
        """The stored findings."""
        return json.loads(self.file.read_text("utf-8")) if self.file.is_file() else {}

    def in_every_run(self) -> set[str]:
        """The names of the inputs that are checked in every run."""
        return set(list(self.stored())[:: self.every])


def findings(corpus: Corpus, wanted: Callable[[str], bool] | None = None) -> Findings:
    """Check a corpus, or those of its inputs whose names are wanted."""
    with tempfile.TemporaryDirectory() as folder, _alone():
        scratch = Path(folder).resolve()
        found = {
            each.name: _lines(each)
            for each in corpus.inputs(scratch)
            if wanted is None or wanted(each.name)
        }
    return dict(sorted(found.items()))


def as_text(found: Mapping[str, list[str]]) -> str:
    """Return the content of a stored file."""
    return json.dumps(found, indent=1, ensure_ascii=False) + "\n"


def difference(corpus: Corpus, before: Findings, now: Findings) -> str:
    """Return what has changed as a diff; empty when nothing has."""
    old, new = as_text(before).splitlines(), as_text(now).splitlines()
    names = f"stored/{corpus.name}", f"now/{corpus.name}"
    return "\n".join(unified_diff(old, new, *names, lineterm="", n=2))


@contextmanager
def _alone() -> Iterator[None]:
    """Let nothing count but the inputs: no slow machine, and no other packages."""
    environment = {name: os.environ[name] for name in _KEPT if name in os.environ}
    with ExitStack() as stack:
        stack.enter_context(patch.dict(os.environ, environment, clear=True))
        patient = partial(MeshFiles, longest=math.inf)
        stack.enter_context(patch("sambot_viz.checks.model_rules.MeshFiles", patient))
        yield


def _lines(each: Input) -> list[str]:
    try:
        problems = each.check()
    except UsageError as error:
        return [_without_folder(f"usage: {error}", each.folder)]
    problems.sort(key=lambda p: (p.file or "", p.line or 0, p.column or 0, str(p)))
    return [
        _without_folder(f"{problem}{_edits(problem, each)}", each.folder)
        for problem in problems
        if _told(problem) not in each.known
    ]


def _edits(problem: Problem, each: Input) -> str:
    """Write the edits of a problem: where, and what becomes what."""
    told: list[str] = []
    for edit in problem.edits:
        file, start, end, new = edit.file, edit.start, edit.end, edit.text
        source = source_of(file)
        written = each.files.get(file, "")
        text = written if isinstance(written, str) else written.decode()
        text = text if source is None else source.text
        line = text.count("\n", 0, start) + 1
        column = start - text.rfind("\n", 0, start)
        name = "" if file == problem.file else f"{file}:"
        told.append(f"{name}{line}:{column} {text[start:end]!r} -> {new!r}")
    return f" [{', '.join(told)}]" if told else ""


def _told(problem: Problem) -> str:
    return f"{problem.code}: {problem.message}"


def _without_folder(text: str, folder: Path | None) -> str:
    text = _SEARCHED.sub(r"(\1 …)", text)
    for each in (folder, Path.cwd()):
        if each is not None:
            text = text.replace(f"{each}/", "").replace(str(each), ".")
    return text


def _check(path: Path, arguments: Mapping[str, str] | None = None) -> list[Problem]:
    """Check a model or a folder as the command does."""
    return list(check_all(path, xacro_args=arguments).problems)


def _input(path: Path, folder: Path, **options: Any) -> Input:
    name = path.relative_to(folder).as_posix()
    return Input(name, partial(_check, path, **options), folder)


def _samples(_: Path) -> Iterator[Input]:
    for sample in all_samples():
        yield Input(
            sample.code,
            lambda sample=sample: list(sample.problems()),
            files=sample.files,
        )


def _probes(scratch: Path) -> Iterator[Input]:
    for probe in quick_yaml(ROOT / "tests" / "data" / "sdf" / "probes.yaml"):
        model = scratch / "model.sdf"
        model.write_text(probe["sdf"], "utf-8")
        yield Input(probe["id"], partial(check, model), scratch)


def _right(_: Path) -> Iterator[Input]:
    packages = ROOT / "tests" / "data" / "around"
    yield _input(packages / "gz", packages)
    yield _input(packages / "classic", packages)
    for name in bundled.model_names():
        yield _input(bundled.model_path(name), ROOT)


def _files(*parts: str) -> Callable[[Path], Iterator[Input]]:
    """Find the models in a folder of the collection, and the packages in it."""

    def inputs(_: Path) -> Iterator[Input]:
        folder = SHARED.resolve().joinpath("data", *parts)
        for path in sorted(folder.rglob("*")):
            if path.name.endswith(MODEL_ENDINGS) and path.parent.name != "worlds":
                yield _input(path, folder)
            elif path.name == "package.xml":
                yield _input(path.parent, folder)

    return inputs


def _robots(_: Path) -> Iterator[Input]:
    folder = SHARED.resolve() / "data" / "robots"
    for robot in real_robots(folder):
        yield _input(folder / robot.path, folder, arguments=robot.arguments)


def _packages(_: Path) -> Iterator[Input]:
    folder = SHARED.resolve() / "data" / "robots"
    for manifest in sorted(folder.rglob("package.xml")):
        yield _input(manifest.parent, folder)


def _tutorial(scratch: Path) -> Iterator[Input]:
    data = SHARED.resolve() / "data"
    for name in ("base-cmake", "base-python"):
        package = _copy(data / "mistakes" / name, scratch)
        for language, check_it in _both(package):
            yield Input(f"{name}{language}", check_it, scratch)
    for model in sorted((data / "seed").iterdir()):
        if model.name.endswith(MODEL_ENDINGS):
            yield _input(model, data)


def _mistakes(scratch: Path) -> Iterator[Input]:
    """Find the wrong packages; what is said of the right ones too is left out."""
    folder = SHARED.resolve() / "data" / "mistakes"
    memory = XacroMemory()
    with patch(
        "sambot_viz.robot.xacro.expansion._run_child",
        lambda job, limits: memory.run_child(job, limits, scratch),
    ):
        known: dict[str, frozenset[str]] = {}
        for change in sorted(folder.glob("*/*.diff")):
            base = "base-python" if change.stem.startswith("p") else "base-cmake"
            if base not in known:
                right = _both(_copy(folder / base, scratch))
                said = [
                    _told(problem) for _, check_it in right for problem in check_it()
                ]
                known[base] = frozenset(said)
            package = _copy(folder / base, scratch)
            text = change.read_text("utf-8")
            apply_patch(text, package)
            name = change.relative_to(folder).with_suffix("").as_posix()
            for language, check_it in _both(package):
                if not language or ".sdf\n" in text:
                    yield Input(f"{name}{language}", check_it, scratch, known[base])


def _copy(package: Path, scratch: Path) -> Path:
    copy = scratch / "sam_bot_description"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(package, copy)
    return copy


def _both(package: Path) -> Iterator[tuple[str, Callable[[], list[Problem]]]]:
    """Yield how to check a package of the tutorial: its folder, its robot in SDF."""
    sdf = package / "src" / "description" / "sam_bot_description.sdf"
    yield "", partial(_check, package)
    yield ", SDF", partial(_check, sdf)


def apply_patch(text: str, folder: Path) -> None:
    """Make the change of a unified diff, whose paths have one folder too many."""
    for gone in re.findall(r"^Only in [^/\n]*/(\S+): (\S+)$", text, re.MULTILINE):
        folder.joinpath(*gone).unlink()
    for change in re.split(r"^--- .*\n(?=\+\+\+ )", text, flags=re.MULTILINE)[1:]:
        target, *hunks = re.split(r"^@@ -(\d+).*\n", change, flags=re.MULTILINE)
        file = folder / target.split()[1].partition("/")[2]
        old = file.read_text("utf-8").splitlines(keepends=True)
        new: list[str] = []
        at = 0
        for first, body in zip(hunks[::2], hunks[1::2], strict=True):
            start = max(0, int(first) - 1)
            new += old[at:start]
            at = start
            for line in body.splitlines(keepends=True):
                if line[0] in " -":
                    assert old[at] == line[1:], f"{file}: {line}"
                    at += 1
                if line[0] in " +":
                    new.append(line[1:])
        file.write_text("".join(new + old[at:]), "utf-8")


CORPORA = (
    Corpus("samples", _samples),
    Corpus("probes", _probes),
    Corpus("right", _right),
    Corpus("tutorial", _tutorial, in_shared=True),
    Corpus("mistakes", _mistakes, in_shared=True),
    Corpus("false-alarms", _files("mistakes", "false-alarms"), in_shared=True),
    Corpus("bad-models", _files("bad-models"), in_shared=True),
    Corpus("sdf", _files("sdf"), in_shared=True),
    Corpus("robots", _robots, in_shared=True, every=8),
    Corpus("packages", _packages, in_shared=True, every=8),
)
"""All of them."""


def _run(words: Collection[str]) -> None:
    names = {word for word in words if not word.startswith("-")}
    for corpus in CORPORA:
        if (names and corpus.name not in names) or (
            corpus.in_shared and not SHARED.is_dir()
        ):
            continue
        found = findings(corpus)
        if changed := difference(corpus, corpus.stored(), found):
            print(changed)
        if "--write" in words:
            STORED.mkdir(exist_ok=True)
            corpus.file.write_text(as_text(found), "utf-8")


if __name__ == "__main__":
    _run(sys.argv[1:])
