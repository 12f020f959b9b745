"""Recorded cases, and messages of our own, opened without a browser."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
import yaml
from camera_messages import unpacked
from inside import session_of
from made_messages import Make, write_messages

from sambot_viz import Visualizer
from sambot_viz.displays.display import Display

MESSAGES = Path(__file__).parents[2] / "golden" / "messages"


class Opened:
    """A page's session that shows a recording; the first display is looked at.

    Attributes:
        viz: what was opened, at the end of the recording.
    """

    def __init__(self, viz: Visualizer, kind: str) -> None:
        self.viz = viz
        self._kind = kind
        viz.player.jump(viz.player.duration)

    @property
    def display(self) -> Any:
        displays: list[Display] = session_of(self.viz).scene.displays
        kinds = (one for one in displays if one.kind.endswith(f"/{self._kind}"))
        return next(kinds)

    @property
    def statuses(self) -> dict[str, tuple[str, str]]:
        rows = self.display.status.rows
        return {key: (row.level, row.text) for key, row in rows.items()}

    def set(self, path: str, value: object) -> None:
        """Set a property as a user does."""
        session_of(self.viz).display_edits.set_property(self.display, path, value)

    def node_names(self) -> list[str]:
        """The nodes that the display has in the scene."""
        return sorted(self._nodes)

    def look(self) -> tuple[dict[str, Any], bytes]:
        """Look at the pictures as a page does; the newest one."""
        session, key = session_of(self.viz), self.display.key
        pictures = session.scene.context.pictures
        with session.lock:
            if not pictures.is_wanted(key):
                pictures.want(key)
        return unpacked(pictures.frames([key])[key][1])

    def look_away(self) -> None:
        """Look at the pictures no longer, as a page whose panel is closed."""
        session, key = session_of(self.viz), self.display.key
        with session.lock:
            session.scene.context.pictures.leave(key)
            self.display.redraw()

    def glb(self) -> bytes:
        """The GLB file of the only node of the display."""
        (node,) = self._nodes.values()
        return bytes(node.glb_data)

    @property
    def _nodes(self) -> dict[str, Any]:
        nodes = self.viz.viser.scene._handle_from_node_name  # pyright: ignore[reportPrivateUsage]
        key = f"/{self.display.key}"
        return {name: node for name, node in nodes.items() if key in name}


@pytest.fixture
def opened() -> Iterator[Callable[[str, str], Opened]]:
    """Opens a recorded case of a display."""
    with ExitStack() as stack:

        def open_case(name: str, kind: str) -> Opened:
            folder = MESSAGES / name
            source, config = f"bag:{folder / 'messages.mcap'}", folder / "config.rviz"
            viz = Visualizer(source=source, config=config, port=0)
            return Opened(stack.enter_context(viz), kind)

        yield open_case


@pytest.fixture
def messages(tmp_path: Path) -> Iterator[Callable[..., Opened]]:
    """Opens messages of a topic /a in a display of it, in the fixed frame map."""
    with ExitStack() as stack:

        def open_messages(
            kind: str,
            *made: Make,
            frame: str = "map",
            definitions: Mapping[str, str] | None = None,
            trusted: bool = True,
            **values: object,
        ) -> Opened:
            path = write_messages(
                tmp_path / "messages.mcap", *made, definitions=definitions
            )
            shown = {
                "Class": f"rviz_default_plugins/{kind}",
                "Name": kind,
                "Enabled": True,
                "Topic": {"Value": "/a"},
                **values,
            }
            shown = {key: one for key, one in shown.items() if one is not None}
            options = {"Fixed Frame": frame}
            manager = {"Class": "", "Displays": [shown], "Global Options": options}
            config = tmp_path / "messages.rviz"
            config.write_text(yaml.safe_dump({"Visualization Manager": manager}))
            source = f"bag:{path}"
            viz = Visualizer(source=source, config=config, port=0, trusted=trusted)
            return Opened(stack.enter_context(viz), kind)

        yield open_messages
