"""What moves a robot beside its sliders: its sources."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import UsageError
from sambot_viz.options import Options

# Most robots are moved by hand.
if TYPE_CHECKING:
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.rviz.yaml.document import Document
    from sambot_viz.rviz.yaml.nodes import Map
    from sambot_viz.sources.source import Source
    from sambot_viz.topics.source_robot import SourceRobot


def open_moved_by(options: Options) -> SourceRobot | None:
    """Open the sources of the options; None when there are none.

    A live robot is not connected yet.

    Raises:
        UsageError: there are sources beside a live robot, or it cannot be recorded
            where the options say.
        SourceError: a recording cannot be opened.
    """
    if not options.sources:
        return None
    from sambot_viz.messages import MessageTypes
    from sambot_viz.topics.source_robot import SourceRobot

    types = MessageTypes([Path(folder) for folder in options.msg_path])
    if not options.live_sources:
        return SourceRobot(_recordings(options), types, at=options.at)
    if len(options.sources) > 1:
        given = ", ".join(str(one) for one in options.source)
        raise UsageError(
            "a live robot is not shown together with recordings or another robot; "
            f"name one of these alone: {given}"
        )
    from sambot_viz.sources.registry import open_source

    source = open_source(options.live_sources[0].uri)
    return SourceRobot(source, types, recordings=_checked_folder(options))


def _checked_folder(options: Options) -> Path | None:
    """Return the folder for recordings of the page's users, if they may record.

    Raises:
        UsageError: a live robot cannot be recorded where the options say.
    """
    from sambot_viz.sources.recorder import check_file, check_folder

    folder = None if options.record_dir is None else Path(options.record_dir)
    if folder is not None:
        check_folder(folder)
    if options.record is not None:
        check_file(Path(options.record))
    return folder


def _recordings(options: Options) -> Source:
    """Open all recordings of the options as one.

    Raises:
        SourceError: one of them cannot be opened.
    """
    from sambot_viz.sources.bag import open_recording
    from sambot_viz.sources.playback import RecordingPlayback

    paths = [Path(given.path) for given in options.sources]
    name = paths[0].name if len(paths) == 1 else f"{len(paths)} recordings"
    recording = open_recording(paths)
    # What is large and without an index is looked through now: a second or two a GB.
    while not recording.index_more():
        pass
    return RecordingPlayback(recording, name)


def refuse_time_of_live(options: Options) -> None:
    """Refuse to look at a time of a robot that is live.

    Raises:
        UsageError: the options name such a robot, and a time.
    """
    if options.at is not None and options.live_sources:
        raise UsageError(
            "--at is a time of a recording; of a live robot the last messages are shown"
        )


def named_descriptions(config: Document | RvizConfig | None) -> tuple[str, ...]:
    """Return the topics of which a config wants robots, in its order.

    Args:
        config: as text or as a document; None for no topics.
    """
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.rviz.yaml.nodes import Map, items_of

    if config is None:
        return ()
    if isinstance(config, RvizConfig):
        return tuple(_topics_of(display.node for display in config.displays))
    manager = config.root.get("Visualization Manager")
    items = manager.get("Displays") if isinstance(manager, Map) else None
    return tuple(_topics_of(display for _, display in items_of(items)))


def _topics_of(displays: Iterable[Map]) -> Iterator[str]:
    from sambot_viz.rviz.yaml.nodes import Map, Scalar, items_of

    for display in displays:
        if display.text("Enabled") == "false":
            continue
        yield from _topics_of(one for _, one in items_of(display.get("Displays")))
        topic = display.get("Description Topic")
        value = topic.get("Value") if isinstance(topic, Map) else topic
        is_file = display.text("Description Source") == "File"
        if isinstance(value, Scalar) and value.text and not is_file:
            yield f"/{value.text.removeprefix('/')}"
