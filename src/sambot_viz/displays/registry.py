"""All displays this program knows: a new one is a new file and a line here."""

from __future__ import annotations

from sambot_viz.displays.axes import AxesDisplay
from sambot_viz.displays.display import Display
from sambot_viz.displays.grid import GridDisplay
from sambot_viz.displays.group import GroupDisplay
from sambot_viz.displays.robot_model.robot_model import RobotModelDisplay
from sambot_viz.displays.tf.tf import TfDisplay

DISPLAYS: dict[str, type[Display]] = {
    display.kind: display
    for display in (
        AxesDisplay,
        GridDisplay,
        GroupDisplay,
        RobotModelDisplay,
        TfDisplay,
    )
}
