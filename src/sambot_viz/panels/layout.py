"""Where the panels stand: Displays at the left, Joints at the right."""

from __future__ import annotations

import viser

from sambot_viz import page
from sambot_viz.panels.displays import DisplaysPanel
from sambot_viz.panels.joints import JointsPanel
from sambot_viz.session import Session

LEFT_WIDTH, RIGHT_WIDTH = 300, 270
"""Widths of the panels [px]; the rest of the window is the view."""


class Layout:
    """The panels of one session.

    Args:
        session: what they show.
        joints: whether there is a Joints panel (``--no-gui`` leaves it out).
    """

    def __init__(self, session: Session, joints: bool = True) -> None:
        gui = session.audience.gui
        gui.main_panel.dock_left()
        gui.main_panel.set_width(LEFT_WIDTH)
        self._root = gui.add_folder(None)
        self._displays = DisplaysPanel(session, self._root)
        self._joints: JointsPanel | None = None
        if joints:
            panel = gui.add_panel()
            self._joints = JointsPanel(session, panel.add_tab("Joints"))
            panel.dock_right()
            panel.set_width(RIGHT_WIDTH)

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
        self._displays.close()
        if self._joints is not None:
            self._joints.close()
