"""``sambot-viz config``: list which parts of a .rviz file are shown or only kept."""

from __future__ import annotations

import os.path
from pathlib import Path

from sambot_viz.bundled import missing
from sambot_viz.commands.command_line import Parser
from sambot_viz.errors import UsageError
from sambot_viz.outlet import write_json, write_lines
from sambot_viz.problems import write_problems


def run(words: list[str]) -> int:
    """Report on a config; 0 when it can be shown, 1 when it is not a .rviz document."""
    options = parser().parse_args(words)
    if not os.path.isfile(options.file):
        raise UsageError(missing("config", Path(options.file)))
    from sambot_viz.inputs import load_config
    from sambot_viz.rviz.support_report import config_report

    found = config_report(load_config(options.file))
    if options.format == "json":
        write_json(found.as_json())
    else:
        write_lines(found.as_text())
        write_problems(found.problems, most=None)
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz config",
        description="Report what of a .rviz file is shown, approximated, or kept "
        "without being shown, display by display. Exit status: 0 fine, 1 not a .rviz "
        "file, 2 usage.",
    )
    made.add_argument("file", metavar="FILE.rviz", help="the file, of ROS 2 or ROS 1")
    made.add_format()
    return made
