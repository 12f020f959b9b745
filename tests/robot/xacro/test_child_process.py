"""The child that runs xacro always ends: by its limits, with its parent, by itself."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from patience import until

from sambot_viz.robot.xacro.child_result import ExpansionError
from sambot_viz.robot.xacro.expansion import Limits, SpareChild, expand_model

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
def started(monkeypatch: pytest.MonkeyPatch) -> list[subprocess.Popen[bytes]]:
    """The children that were started so far."""
    children: list[subprocess.Popen[bytes]] = []
    popen: Any = subprocess.Popen

    def start(*args: Any, **options: Any) -> subprocess.Popen[bytes]:
        children.append(popen(*args, **options))
        return children[-1]

    monkeypatch.setattr(subprocess, "Popen", start)
    return children


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
    started: list[subprocess.Popen[bytes]],
) -> None:
    files = len(os.listdir("/proc/self/fd")) if sys.platform == "linux" else 0
    found = failure(text, limits, trusted)
    # What cannot end well is refused beforehand in an untrusted model.
    assert found.startswith(kind) or (found == "Refused" and not trusted)
    assert [child.returncode is not None for child in started] == [True]
    if files:
        assert len(os.listdir("/proc/self/fd")) <= files


def test_two_loads_at_once_do_not_wait_for_each_others_children(
    started: list[subprocess.Popen[bytes]],
) -> None:
    good = HEAD + "<link name='${1 + 1}'/></robot>"
    with ThreadPoolExecutor(4) as pool:
        endless = pool.submit(failure, ENDLESS, Limits(seconds=3.0), True)
        texts = list(pool.map(expand, [good] * 6))
        assert not endless.done()
        assert endless.result() == "Timeout"
    assert all('name="2"' in text for text in texts)
    assert all(child.returncode is not None for child in started)


def test_a_child_that_was_started_ahead_expands_the_next_model(
    started: list[subprocess.Popen[bytes]],
) -> None:
    good, spare = HEAD + "<link name='${1 + 1}'/></robot>", SpareChild()
    for count in (2, 3):
        with spare.used():
            assert 'name="2"' in expand(good)
        assert len(started) == count
    # One that has ended meanwhile is no loss.
    started[-1].kill()
    started[-1].wait()
    with spare.used():
        assert 'name="2"' in expand(good)
    # In other threads, and behind the block, it is left alone.
    expand(good)
    spare.end()
    assert all(child.returncode is not None for child in started)


def test_a_large_text_is_handed_over_whole() -> None:
    comment = f"<!-- {'x' * 3_000_000} -->"
    assert comment in expand(f"{HEAD}{comment}<link name='a'/></robot>")


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    "text", [ENDLESS, HEAD + "<link name='${sum(range(10**10))}'/></robot>"]
)
def test_the_child_ends_when_its_parent_is_killed(text: str, tmp_path: Path) -> None:
    model = tmp_path / "endless.urdf.xacro"
    model.write_text(text.replace("sum(", "python.sum("))
    with subprocess.Popen(
        [sys.executable, "-c", TELLING, str(model)], stdout=subprocess.PIPE, text=True
    ) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        parent.kill()
    until(lambda: not is_running(child), why="the child goes on without its parent")


def is_running(process: int) -> bool:
    """Whether it exists and is not a zombie."""
    try:
        stat = Path(f"/proc/{process}/stat").read_text()
    except OSError:
        return False
    return stat.rpartition(")")[2].split()[0] != "Z"
