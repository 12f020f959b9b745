"""The condition about the config of RViz."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sambot_viz.errors import ConfigError
from sambot_viz.lessons.conditions.condition import Unmet
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import TEXTS
from sambot_viz.lessons.work import Work


@dataclass(frozen=True, slots=True, kw_only=True)
class RvizCondition:
    """The folder has a config that opens; its fixed frame exists, and displays."""

    displays: tuple[str, ...] = given(TEXTS, ())

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Read the first config of the folder."""
        # The import is late: few conditions need it.
        from sambot_viz.rviz import Declarations, RvizConfig

        paths = work.files.ending(".rviz")
        if not paths:
            yield Unmet("there is no .rviz file", "one that RViz opens")
            return
        shown = work.files.shown(paths[0])
        if work.files.text(paths[0]) is None:
            yield Unmet(f"{shown} cannot be read", "a config")
            return
        try:
            config = RvizConfig.load(Path(shown), Declarations())
        except ConfigError as error:
            problem = error.problems[0]
            yield Unmet(f"{problem.place}: {problem.message}", "a config that opens")
            return
        frame = str(config.global_options.get("Fixed Frame"))
        if frame not in work.robot.links:
            yield Unmet(f"the Fixed Frame of {shown} is {frame}", "a link of the robot")
        classes = [display.class_id for display in config.displays]
        for wanted in self.displays:
            if not any(name.rpartition("/")[2] == wanted for name in classes):
                yield Unmet(f"{shown} has no display {wanted}", "one")
