"""What moves a robot beside its sliders: recordings, or a live robot."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import UsageError
from sambot_viz.options import Options

# Most robots are moved by hand.
if TYPE_CHECKING:
    from sambot_viz.topics.live_robot import LiveRobot
    from sambot_viz.topics.recorded_robot import RecordedRobot


def open_live(options: Options) -> LiveRobot | None:
    """Return the live robot of the options, not connected yet; None without one.

    Raises:
        UsageError: there are further sources beside it.
    """
    if not options.live_sources:
        return None
    if len(options.source) > 1:
        raise UsageError("a live source is the only one: give one --source")
    from sambot_viz.messages import MessageTypes
    from sambot_viz.sources.registry import open_source
    from sambot_viz.topics.live_robot import LiveRobot

    types = MessageTypes([Path(folder) for folder in options.msg_path])
    return LiveRobot(open_source(options.live_sources[0]), types)


def open_recorded(options: Options) -> RecordedRobot | None:
    """Open the recordings of the options; None when there are none.

    Raises:
        SourceError: one of them cannot be opened.
    """
    if not options.source:
        return None
    from sambot_viz.messages import MessageTypes
    from sambot_viz.sources.bag import open_recording
    from sambot_viz.topics.recorded_robot import RecordedRobot

    paths = [Path(uri.removeprefix("bag:")) for uri in options.source]
    types = MessageTypes([Path(folder) for folder in options.msg_path])
    name = paths[0].name if len(paths) == 1 else f"{len(paths)} recordings"
    recording = open_recording(paths)
    # What is large and without an index is looked through now: a second or two a GB.
    while not recording.index_more():
        pass
    return RecordedRobot(recording, types, name, options.at)
