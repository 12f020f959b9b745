"""Tests wait on conditions and count: no sleep, and no clock of the computer.

What takes 50 ms on one machine takes a second on another that is busy. A session has a
clock that a test moves (`hand_clock`), `patience.until` waits for what must come, and
`work.calls_of` counts what something costs.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

CLOCKS = {
    "time": {
        "sleep",
        "time",
        "time_ns",
        "monotonic",
        "monotonic_ns",
        "perf_counter",
        "perf_counter_ns",
    },
    "asyncio": {"sleep"},
    "threading": {"Timer"},
}
"""Module → its names that sleep, or tell the time of the computer."""

PATIENT = 5.0
"""What waits shorter is expected to run out, and so is a sleep [s]."""

MAY = {
    "support/patience.py": "waits for all tests",
    "commands/test_live.py": "drives a robot as long as a command listens",
    "server/test_server.py": "holds a save up, which another one may wait for",
    "support/a_class.py": "waits with a deadline",
    "support/protocol_client.py": "waits with a deadline, and notes when frames came",
    "support/a_jupyter.py": "waits for another program",
    "support/browser_input.py": "moves a mouse as fast as a hand does",
    "support/crowd.py": "measures, for benchmarks",
    "support/data_loads.py": "measures, for benchmarks",
    "support/docs_parts/make_pictures.py": "films a page at a rate",
    "support/reconnecting.py": "measures, for benchmarks",
    "support/steps.py": "measures, for benchmarks",
    "support/usage.py": "measures, for benchmarks",
    "support/slow_line.py": "is a slow line",
    "support/troublemakers.py": "sends garbage at a rate",
    "sources/test_real_rosbridge.py": "has the clock of its robot in this computer",
    "browser/test_keys_and_mouse.py": "moves a mouse for two seconds, to count",
    "browser/test_reload.py": "waits until a picture is the same twice",
    "browser/test_views_and_tools.py": "waits while a page goes on drawing",
}
"""Files that may, and what for; folders of benchmarks are no tests."""


@cache
def python_files(repository: Path) -> list[Path]:
    found = (repository / "tests").rglob("*.py")
    return sorted(p for p in found if not {".venv", "benchmarks"} & {*p.parts})


def uses(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the lines that sleep or look at a clock, and how."""
    taken: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module in CLOCKS:
            taken |= {
                alias.asname or alias.name: f"{node.module}.{alias.name}"
                for alias in node.names
                if alias.name in CLOCKS[node.module]
            }
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = _dotted(node.func)
            name = taken.get(name, name)
            module, _, last = name.rpartition(".")
            found = last in CLOCKS.get(module, ()) or _runs_out(node)
            if found and not _gives_way(node):
                yield node.lineno, name


def _dotted(node: ast.expr) -> str:
    """Return ``time.sleep`` as it is written; "" for what is no name."""
    if isinstance(node, ast.Attribute):
        return f"{_dotted(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else ""


def _runs_out(call: ast.Call) -> bool:
    """Whether it is a pause: a wait that is shorter than `PATIENT`."""
    if not isinstance(call.func, ast.Attribute) or call.func.attr != "wait":
        return False
    given = [*call.args[:1], *(k.value for k in call.keywords if k.arg == "timeout")]
    numbers = [one.value for one in given if isinstance(one, ast.Constant)]
    return any(isinstance(n, int | float) and n < PATIENT for n in numbers)


def _gives_way(call: ast.Call) -> bool:
    """Whether it only lets others go first: ``asyncio.sleep(0)``."""
    return [ast.unparse(word) for word in call.args] == ["0"]


def test_no_test_sleeps_or_looks_at_a_clock(repository: Path) -> None:
    found = [
        f"{path.relative_to(repository)}:{line}: {how}"
        for path in python_files(repository)
        if path.relative_to(repository / "tests").as_posix() not in MAY
        for line, how in uses(ast.parse(path.read_text("utf-8")))
    ]
    assert found == []


@pytest.mark.parametrize(
    "text",
    [
        "import time\ntime.sleep(0.1)",
        "from time import monotonic as now\nnow()",
        "import threading\nthreading.Timer(1, print)",
        "import asyncio\nasync def f():\n    await asyncio.sleep(0.1)",
        "event.wait(0.2)",
        "process.wait(timeout=1)",
    ],
)
def test_a_sleep_is_noticed(text: str) -> None:
    assert [*uses(ast.parse(text))]


def test_to_give_way_is_no_sleep() -> None:
    assert not [*uses(ast.parse("import asyncio\nasyncio.sleep(0)"))]
