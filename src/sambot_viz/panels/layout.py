"""The places of the panels: Displays at the left, the others as tabs at the right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import viser

from sambot_viz import page
from sambot_viz.panels.displays import DisplaysPanel
from sambot_viz.panels.drive import DrivePanel
from sambot_viz.panels.frames import FramesPanel
from sambot_viz.panels.joints import JointsPanel
from sambot_viz.panels.optional_tab import OptionalTab
from sambot_viz.panels.problems import ProblemsPanel
from sambot_viz.panels.progress import ProgressLine
from sambot_viz.panels.selection import SelectionPanel
from sambot_viz.panels.tools import ToolBar
from sambot_viz.panels.views import ViewsPanel
from sambot_viz.session import Session

LEFT_WIDTH, RIGHT_WIDTH = 300, 270
"""Widths of the panels [px]; the rest of the window is the view."""


class Panel(Protocol):
    """What is made for a tab and fills it."""

    def close(self) -> None:
        """Follow the session no longer."""


@dataclass(frozen=True, slots=True)
class Tab:
    """A tab at the right.

    Attributes:
        title: its label.
        make: makes the panel that fills it.
        for_joints: left out by ``--no-gui``.
    """

    title: str
    make: Callable[[Session, viser.GuiTabHandle], Panel]
    for_joints: bool = False


RIGHT_TABS: tuple[Tab, ...] = (
    Tab("Joints", JointsPanel, for_joints=True),
    Tab("Frames", FramesPanel),
    Tab("Views", ViewsPanel),
    Tab("Selection", SelectionPanel),
)
"""All panels at the right: a new one is a new file and a line here."""


class Layout:
    """The panels of one session.

    Args:
        session: what they show.
        joints: whether there are panels to move joints (``--no-gui`` leaves them out).
    """

    def __init__(self, session: Session, joints: bool = True) -> None:
        gui = session.audience.gui
        gui.main_panel.dock_left()
        self._panels: list[Panel] = [
            ToolBar(session, gui.add_folder(None)),
            ProgressLine(session),
            DisplaysPanel(session, gui.add_folder(None)),
        ]
        gui.main_panel.set_width(LEFT_WIDTH)
        tabs = [tab for tab in RIGHT_TABS if joints or not tab.for_joints]
        if tabs:
            right = gui.add_panel()
            for tab in tabs:
                self._panels.append(tab.make(session, right.add_tab(tab.title)))
            if joints:
                drive = OptionalTab(session, right, "Drive", DrivePanel, can_drive)
                self._panels.append(drive)
            right.dock_right()
            below = gui.add_panel()
            self._panels.append(ProblemsPanel(session, below))
            below.dock_below(right)
            right.set_width(RIGHT_WIDTH)

    @staticmethod
    def prepare_page(server: viser.ViserServer) -> None:
        """What every browser gets whatever its session: theme, style, script, light."""
        gui, scene = server.gui, server.scene
        gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False)
        gui.set_panel_label("sambot-viz")
        gui.add_html(page.style_element() + page.script_element())
        # Without the script the page still has light to see by.
        scene.configure_default_lights(enabled=False)
        scene.configure_environment_map(None)
        scene.add_light_ambient("/~ambient", intensity=2.0)

    def close(self) -> None:
        """Follow the session no longer."""
        for panel in self._panels:
            panel.close()


def can_drive(session: Session) -> bool:
    """Whether the session's robot has two wheels to drive with."""
    return session.motion.drive.wheels is not None
