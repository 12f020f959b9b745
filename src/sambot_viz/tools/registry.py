"""All tools this program knows: a new one is a new file and a line here."""

from __future__ import annotations

from sambot_viz.tools.focus_camera import FocusCameraTool
from sambot_viz.tools.interact import InteractTool
from sambot_viz.tools.measure import MeasureTool
from sambot_viz.tools.move_camera import MoveCameraTool
from sambot_viz.tools.publish import (
    NavGoalTool,
    PublishPointTool,
    SetGoalTool,
    SetInitialPoseTool,
)
from sambot_viz.tools.select import SelectTool
from sambot_viz.tools.tool import Tool

TOOLS: dict[str, type[Tool]] = {
    tool.kind: tool
    for tool in (
        InteractTool,
        MoveCameraTool,
        SelectTool,
        FocusCameraTool,
        MeasureTool,
        SetInitialPoseTool,
        SetGoalTool,
        NavGoalTool,
        PublishPointTool,
    )
}
