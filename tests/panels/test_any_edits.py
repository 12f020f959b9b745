"""After any edits of displays and frames a page shows what a new one shows."""

from __future__ import annotations

import random
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from inside import session_of
from page_rows import PageRows, decode
from panel_rows import panel_of

from sambot_viz import SambotVizError, Visualizer, load_robot
from sambot_viz.panels import row_sync
from sambot_viz.panels.displays.displays_panel import DisplaysPanel
from sambot_viz.panels.frames.frames_panel import FramesPanel
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.row_sync import RowSync
from sambot_viz.panels.rows.row_store import RowStore
from sambot_viz.session import Session
from sambot_viz.session.scene.scene import walk

CLIENT = 7
LINKS = ("base", "arm", "hand", "tool")
KINDS = ("rviz_common/Group", "rviz_default_plugins/Axes", "rviz_default_plugins/TF")


def robot(chance: random.Random) -> str:
    """A model in which each link but the first is below any one before it."""
    joints = (
        f'<joint name="j{n}" type="continuous"><axis xyz="0 0 1"/>'
        f'<parent link="{chance.choice(LINKS[:n])}"/><child link="{LINKS[n]}"/></joint>'
        for n in range(1, len(LINKS))
    )
    links = (f'<link name="{name}"/>' for name in LINKS)
    return f'<robot name="r">{"".join(links)}{"".join(joints)}</robot>'


class Page:
    """A page that is sent the rows of some panels."""

    def __init__(self, store: RowStore) -> None:
        self._store = store
        self._rows = PageRows()
        self._version = 0

    def rows(self) -> list[dict[str, object]]:
        """All rows, in order, after what it lacked."""
        self._version, message = self._store.since(self._version)
        if message is not None:
            self._rows.take(decode(message))
        return list(self._rows.by_id().values())


def steps(session: Session, chance: random.Random) -> list[Callable[[], object]]:
    """What a user may do next."""
    edits = session.display_edits
    known = list(walk(session.document.config.displays))
    one = chance.choice(known)
    group = chance.choice([None, *(d for d in known if d.kind.endswith("Group"))])
    return [
        lambda: edits.add_display(chance.choice(KINDS), after=one),
        lambda: edits.move_display(one, chance.randrange(4), group),
        lambda: edits.move_display(one, chance.randrange(4), group),
        lambda: edits.duplicate_display(one),
        lambda: edits.rename_display(one, f"n{chance.randrange(9)}"),
        lambda: edits.set_enabled(one, not one.enabled),
        lambda: edits.remove_display(one) if len(known) > 3 else None,
        lambda: session.robot.randomize(),
    ]


def act(session: Session, chance: random.Random) -> None:
    """Do one of these, or undo and redo what was done; what is refused is no matter."""
    history = session.history
    with suppress(SambotVizError):
        if chance.random() < 0.3:
            chance.choice((history.undo, history.redo))(CLIENT)
            return
        with history.acting(CLIENT):
            chance.choice(steps(session, chance))()


@pytest.mark.parametrize("seed", range(4))
def test_a_page_shows_what_a_new_one_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    monkeypatch.setattr(row_sync, "PERIOD", 0.0)
    monkeypatch.setattr(FramesPanel, "period", 0.0)
    chance = random.Random(seed)
    model = tmp_path / "robot.urdf"
    model.write_text(robot(chance), "utf-8")
    with Visualizer(model, port=0, watch=False) as viz:
        session = session_of(viz)
        kinds: tuple[type[Panel], ...] = (DisplaysPanel, FramesPanel)
        panels = [panel_of(kind, session) for kind in kinds]
        sync = RowSync(session.worker, panels, "session")
        page = Page(sync.store)
        page.rows()
        for _ in range(100):
            act(session, chance)
            assert page.rows() == Page(sync.store).rows()
        for _ in range(4):
            model.write_text(robot(chance), "utf-8")
            session.show_robot(load_robot(model))
            assert page.rows() == Page(sync.store).rows()
        sync.close()
