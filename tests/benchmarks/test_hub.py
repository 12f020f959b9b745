r"""A course on a real JupyterHub: a server, a lesson and a page for each student.

    SAMBOT_VIZ_STUDENTS=60 python -m pytest tests/benchmarks/test_hub.py \
        -o faulthandler_timeout=0

All are processes of this machine. Students come a few at a time; each opens the tile,
which shows the lesson. What a student costs is the growth of all processes of the
course; memory is the share of each process in it (PSS): common pages count once.
"""

from __future__ import annotations

import os
import re
import statistics
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import Request, urlopen

import pytest
from a_class import BoardRows, write
from a_hub_class import SECRET, board_lines
from a_jupyter import Hub, User, a_hub, a_place, free_ports, wait_until
from protocol_client import ProtocolClient
from usage import usage

STUDENTS = int(os.environ.get("SAMBOT_VIZ_STUDENTS", "3"))
AT_ONCE = 2
"""So many students start at a time: one for each core."""
LONGEST, COME = 300, 720
"""How long the start of one may take, and that of all who are started [s]."""
REST, TYPED = 20.0, 20.0
"""How long nothing happens, and how long the board follows those who type [s]."""
LESSON = "nav2-first-robot"
TEXT = '<robot name="{0}"><link name="base_link"/></robot>'
KINDS: Mapping[str, str] = {
    "hub": r"-m jupyterhub -f",
    "proxy": r"configurable-http-proxy",
    "JupyterLab": r"jupyterhub\.singleuser",
    "lesson": r"sambot_viz\.jupyter|sambot_viz\.robot",
    "board": r"-m sambot_viz class",
}
"""Kinds of processes, by their commands."""


@pytest.mark.slow
def test_a_course_on_a_hub(capsys: pytest.CaptureFixture[str]) -> None:
    names = [f"student-{number:02}" for number in range(1, STUDENTS + 1)]
    with a_place() as place, ExitStack() as pages:
        folder = place.folder / "class"
        folder.mkdir()
        for name in names:
            (place.folder / name).mkdir()
        lines = board_lines(LESSON, folder, *free_ports(1))
        lines.append(f"c.Spawner.start_timeout = c.Spawner.http_timeout = {LONGEST}")
        hub = pages.enter_context(a_hub(place, *lines))
        empty = memory_of(hub)
        began = time.perf_counter()
        with ThreadPoolExecutor(AT_ONCE) as pool:
            came = [*pool.map(lambda name: arrive(hub, name, began + COME), names)]
        come = [one for one in came if one is not None]
        whole = time.perf_counter() - began
        for _, _, page in come:
            pages.callback(page.close)
        full, before = memory_of(hub), computing(hub)
        time.sleep(REST)
        rest = growth(before, computing(hub), REST)
        with board_of(hub) as board:
            board.until(lambda: len(board.rows) >= len(come), LONGEST)
            before, end = computing(hub), time.perf_counter() + TYPED
            for number, (_, _, page) in enumerate(come):
                write(page, TEXT.format(f"robot_{number}"))
            board.until(
                lambda: sum(r["unmet"] > 0 for r in board.rows.values()) >= len(come),
                LONGEST,
            )
            later = max(0.0, end - time.perf_counter())
            time.sleep(later)
            typed = growth(before, computing(hub), TYPED)
        labs, tiles = ([one[at] for one in come] for at in (0, 1))
    with capsys.disabled():
        print(
            f"\n  {len(come)} of {STUDENTS} students, {AT_ONCE} at a time, in "
            f"{whole:.0f} s; JupyterLab after {times(labs)}, the lesson {times(tiles)} "
            "later"
        )
        for kind in KINDS:
            print(
                f"  {kind}: {empty[kind]:.0f} → {full[kind]:.0f} MB; of a core at rest "
                f"{100 * rest[kind]:.1f} %, while each types once and the board "
                f"follows {100 * typed[kind]:.1f} %"
            )
    assert come and full["lesson"] < 2 * full["JupyterLab"]
    assert typed["board"] < 0.5


def times(found: list[float]) -> str:
    return f"{statistics.median(found):.1f} s (longest {max(found):.1f} s)"


def arrive(
    hub: Hub, name: str, until: float
) -> tuple[float, float, ProtocolClient] | None:
    """Log in and open the lesson; how long both took [s], and the page.

    Returns:
        None after the end of the time for all.
    """
    began = time.perf_counter()
    if began > until:
        return None
    user: User = hub.log_in(name, LONGEST)
    logged_in = time.perf_counter()
    path = f"user/{name}/robot-viewer/"
    wait_until(lambda: user.ask(path)[0] == 200, LONGEST)
    headers = {**user.cookies(path), "Origin": user.url.rstrip("/")}
    port = urlsplit(user.url).port or 0
    page = ProtocolClient(port, path=f"/{path}", headers=headers)
    page.wait_until(lambda: "lesson/text" in page.rows, LONGEST)
    return logged_in - began, time.perf_counter() - logged_in, page


@contextmanager
def board_of(hub: Hub) -> Iterator[BoardRows]:
    """Open the teacher's board."""
    headers = {"Authorization": f"Bearer {SECRET}"}
    request = Request(f"{hub.url}services/board/board/rows", headers=headers)
    with urlopen(request, timeout=120.0) as lines:
        yield BoardRows(lines)


def kind_of(command: str) -> str:
    found = (kind for kind, words in KINDS.items() if re.search(words, command))
    return next(found, "other")


def memory_of(hub: Hub) -> Counter[str]:
    """Kind of processes → their share of memory [MB]."""
    found: Counter[str] = Counter()
    for number, command in hub.place.processes().items():
        with suppress(OSError):
            text = (Path("/proc") / str(number) / "smaps_rollup").read_text("utf-8")
            share = re.search(r"^Pss:\s+(\d+)", text, re.MULTILINE)
            found[kind_of(command)] += int(share[1]) / 1024 if share else 0
    return found


def computing(hub: Hub) -> Counter[str]:
    """Kind of processes → time that they have computed [s]."""
    found: Counter[str] = Counter()
    for number, command in hub.place.processes().items():
        with suppress(OSError):
            found[kind_of(command)] += usage(number).cpu
    return found


def growth(
    before: Mapping[str, float], after: Mapping[str, float], seconds: float
) -> Counter[str]:
    """Kind of processes → part of a core that they have used."""
    found: Counter[str] = Counter()
    for kind, cpu in after.items():
        found[kind] = max(0.0, cpu - before.get(kind, 0.0)) / seconds
    return found
