"""Values of objects that threads compute beside each other."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from patience import patience

from sambot_viz.cached import cached_property


class Waiting:
    """An object whose value is there when two of its kind are asked for theirs."""

    def __init__(self, meeting: threading.Barrier) -> None:
        self._meeting = meeting
        self.count = 0

    @cached_property
    def value(self) -> int:
        self.count += 1
        return self._meeting.wait(patience(30.0))


def test_an_object_does_not_wait_for_the_value_of_another_one() -> None:
    meeting = threading.Barrier(2)
    objects = [Waiting(meeting) for _ in range(2)]
    with ThreadPoolExecutor(2) as pool:
        found = list(pool.map(lambda one: one.value, objects))
    assert sorted(found) == [0, 1]
    assert [one.value for one in objects] == found
    assert [one.count for one in objects] == [1, 1]


def test_no_module_has_those_with_a_lock(repository: Path) -> None:
    sources = repository / "src" / "sambot_viz"
    own = sources / "cached.py"
    for path in sources.rglob("*.py"):
        lines = path.read_text("utf-8").splitlines()
        imports = [line for line in lines if line.startswith("from functools import")]
        assert path == own or "cached_property" not in " ".join(imports), path
