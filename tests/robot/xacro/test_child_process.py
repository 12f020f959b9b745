"""The child that runs xacro always ends: by its limits, with its parent, by itself."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from patience import until

from sambot_viz.robot.xacro import expansion
from sambot_viz.robot.xacro.child_result import ExpansionError
from sambot_viz.robot.xacro.expansion import Limits, expand_model

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
ENDLESS = f"""{HEAD}
  <xacro:macro name="m" params="n">
    <xacro:if value="${{n > 0}}">
      <xacro:m n="${{n - 1}}"/><xacro:m n="${{n - 1}}"/>
    </xacro:if>
  </xacro:macro>
  <xacro:m n="60"/>
  <link name="a"/>
</robot>
"""
GOOD = HEAD + "<link name='${1 + 1}'/></robot>"
TELLING = """
import subprocess, sys

class Telling(subprocess.Popen):
    def __init__(self, *args, **options):
        super().__init__(*args, **options)
        print(self.pid, flush=True)

subprocess.Popen = Telling
from sambot_viz.robot.model import load_robot
load_robot(sys.argv[1])
"""


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[subprocess.Popen[bytes]]]:
    """The processes that were started so far; the one that forks is not there yet."""
    children: list[subprocess.Popen[bytes]] = []
    popen: Any = subprocess.Popen

    def start(*args: Any, **options: Any) -> subprocess.Popen[bytes]:
        children.append(popen(*args, **options))
        return children[-1]

    expansion._forks().end()  # pyright: ignore[reportPrivateUsage]
    monkeypatch.setattr(subprocess, "Popen", start)
    yield children
    expansion._forks().end()  # pyright: ignore[reportPrivateUsage]
    assert all(child.returncode is not None for child in children)


@pytest.fixture(params=[True, False], ids=["forks", "without fork"])
def forks(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Whether this system can fork; Windows cannot."""
    if not request.param:
        monkeypatch.setattr(expansion, "CAN_FORK", False)
    elif not expansion.CAN_FORK:
        pytest.skip("this system has no fork")
    return request.param


LIMITS = Limits()


def expand(text: str, limits: Limits = LIMITS, trusted: bool = True) -> str:
    return expand_model(
        "<text>", text, arguments={}, package_path=(), trusted=trusted, limits=limits
    ).text


def failure(text: str, limits: Limits, trusted: bool) -> str:
    with pytest.raises(ExpansionError) as caught:
        expand(text, limits, trusted)
    return caught.value.failure.kind


@pytest.mark.parametrize("trusted", [True, False])
@pytest.mark.parametrize(
    ("text", "limits", "kind"),
    [
        (ENDLESS, Limits(seconds=0.5), "Timeout"),
        (HEAD + "${[0] * 10**9}</robot>", Limits(megabytes=200), "MemoryError"),
        (HEAD + "<link name='a'/>" * 200 + "</robot>", Limits(characters=9), "Output"),
    ],
)
def test_every_limit_ends_the_child_and_collects_it(
    text: str,
    limits: Limits,
    kind: str,
    trusted: bool,
    forks: bool,
    started: list[subprocess.Popen[bytes]],
) -> None:
    expand(GOOD)
    before = processes_and_files(started)
    found = failure(text, limits, trusted)
    # What cannot end well is refused beforehand in an untrusted model.
    assert found.startswith(kind) or (found == "Refused" and not trusted)
    assert processes_and_files(started) == before
    assert len(started) == (1 if forks else 2)


def processes_and_files(
    started: list[subprocess.Popen[bytes]],
) -> tuple[int, int] | None:
    """How many processes run below this one, and how many files this one has open."""
    if sys.platform != "linux":
        return None
    running = [child.pid for child in started if child.returncode is None]
    below = [pid for each in running for pid in [each, *children_of(each)]]
    return len(below), len(os.listdir("/proc/self/fd"))


def children_of(process: int) -> list[int]:
    text = Path(f"/proc/{process}/task/{process}/children").read_text()
    return [int(word) for word in text.split()]


def test_two_loads_at_once_do_not_wait_for_each_others_children(forks: bool) -> None:
    with ThreadPoolExecutor(4) as pool:
        endless = pool.submit(failure, ENDLESS, Limits(seconds=3.0), True)
        texts = list(pool.map(expand, [GOOD] * 6))
        assert not endless.done()
        assert endless.result() == "Timeout"
    assert all('name="2"' in text for text in texts)


def test_one_process_is_started_for_all_models(
    forks: bool, started: list[subprocess.Popen[bytes]]
) -> None:
    for _ in range(3):
        assert 'name="2"' in expand(GOOD)
    assert len(started) == (1 if forks else 3)


@pytest.mark.skipif(not expansion.CAN_FORK, reason="needs fork")
def test_a_process_that_has_ended_meanwhile_is_no_loss(
    started: list[subprocess.Popen[bytes]],
) -> None:
    expand(GOOD)
    for known in (True, False):
        started[-1].kill()
        if known:
            started[-1].wait()
        assert 'name="2"' in expand(GOOD)
    assert len(started) == 3


def test_names_are_relative_to_where_the_program_is_now(
    forks: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("a", "b"):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "part.xacro").write_text(f"{HEAD}<link name='{name}'/></robot>")
        monkeypatch.chdir(folder)
        assert f'name="{name}"' in expand(
            f"{HEAD}<xacro:include filename='part.xacro'/></robot>"
        )


def test_a_large_text_is_handed_over_whole(forks: bool) -> None:
    comment = f"<!-- {'x' * 3_000_000} -->"
    assert comment in expand(f"{HEAD}{comment}<link name='a'/></robot>")


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    "text", [ENDLESS, HEAD + "<link name='${sum(range(10**10))}'/></robot>"]
)
def test_the_children_end_when_their_parent_is_killed(
    text: str, tmp_path: Path
) -> None:
    model = tmp_path / "endless.urdf.xacro"
    model.write_text(text.replace("sum(", "python.sum("))
    with subprocess.Popen(
        [sys.executable, "-c", TELLING, str(model)], stdout=subprocess.PIPE, text=True
    ) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        (fork,) = until(lambda: children_of(child))
        parent.kill()
    for each in (fork, child):
        until(lambda p=each: not is_running(p), why="it goes on without its parent")


def is_running(process: int) -> bool:
    """Whether it exists and is not a zombie."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"
