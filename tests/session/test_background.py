"""Work in the thread of a session: the latest of each owner, now or later."""

from __future__ import annotations

import threading

from patience import patience

from sambot_viz.session.background import Background


def test_work_that_waits_is_replaced_and_done_behind_what_is_due() -> None:
    background, done = Background("test"), list[str]()
    blocked = threading.Event()
    background.do("first", lambda: blocked.wait(patience(10.0)))
    background.do("late", lambda: done.append("early"), after=0.0)
    background.do("late", lambda: done.append("late"), after=0.01)
    background.do("now", lambda: done.append("now"))
    blocked.set()
    assert background.wait(patience(10.0))
    assert done == ["now", "late"]
