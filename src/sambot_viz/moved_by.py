"""What moves a robot beside its sliders: its sources."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.errors import UsageError
from sambot_viz.options import Options

# Most robots are moved by hand.
if TYPE_CHECKING:
    from sambot_viz.messages import MessageTypes
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.rviz.yaml.yaml_document import Document
    from sambot_viz.rviz.yaml.yaml_nodes import Map
    from sambot_viz.sources.given import GivenSource
    from sambot_viz.sources.recorder import RecordingPlace
    from sambot_viz.sources.source import Source
    from sambot_viz.topics.source_robot import SourceRobot

    Given = Sequence[GivenSource]


def open_moved_by(options: Options) -> SourceRobot | None:
    """Open the sources of the options; None when there are none.

    A live robot is not connected yet.

    Raises:
        UsageError: a live robot cannot be recorded where the options say.
        SourceError: a recording cannot be opened.
    """
    if not options.sources:
        return None
    if not options.live_sources:
        return open_recorded(options, options.sources, options.at)
    from sambot_viz.sources.joined import JoinedSources
    from sambot_viz.topics.source_robot import SourceRobot

    lives = [_live(given) for given in options.live_sources]
    place = _checked_place(options)
    recorded = [given for given in options.sources if not given.is_live]
    sources: list[Source] = [] if not recorded else [_recordings(recorded)]
    sources.append(lives[0] if len(lives) == 1 else JoinedSources(lives))
    source = sources[0] if len(sources) == 1 else JoinedSources(sources)
    return SourceRobot(source, _types(options), at=options.at, recordings=place)


def open_recorded(
    options: Options, given: Given, at: float | None = None
) -> SourceRobot:
    """Open recordings, those of the options or others.

    Args:
        options: where definitions of messages are.
        given: the recordings.
        at: where to begin [s from the first message]; None plays from there.

    Raises:
        SourceError: one of them cannot be opened.
    """
    from sambot_viz.topics.source_robot import SourceRobot

    moved_by = SourceRobot(_recordings(given), _types(options), at=at)
    moved_by.given = given
    return moved_by


def _types(options: Options) -> MessageTypes:
    from sambot_viz.messages import MessageTypes

    return MessageTypes([Path(folder) for folder in options.msg_path])


def refuse_mixture(options: Options) -> None:
    """Refuse to look once at a live robot together with other sources.

    Raises:
        UsageError: the options name such a robot, and others or a prefix.
    """
    renamed = any(given.is_renamed for given in options.live_sources)
    if options.live_sources and (len(options.sources) > 1 or renamed):
        raise UsageError(
            "a command that looks once listens to one robot, without a prefix or "
            "--remap: name one source; the page shows several"
        )


def _live(given: GivenSource) -> Source:
    """Return a live robot, not connected yet."""
    from sambot_viz.sources.live.address import without_secrets
    from sambot_viz.sources.prefixed_source import PrefixedSource
    from sambot_viz.sources.registry import open_source

    source = open_source(given.uri)
    # Pages show it, and whoever counts.
    source.uri = given.name or without_secrets(source.uri)
    if not given.is_renamed:
        return source
    return PrefixedSource(source, given.prefix, given.remaps)


def _checked_place(options: Options) -> RecordingPlace | None:
    """Return where recordings of the page's users go, if they may record.

    Raises:
        UsageError: a live robot cannot be recorded where the options say.
    """
    from sambot_viz.sources.recorder import RecordingPlace, check_file, check_folder

    place = None
    if options.record_dir is not None:
        place = RecordingPlace(Path(options.record_dir), options.max_bag_duration)
        check_folder(place.folder)
    if options.record is not None:
        check_file(Path(options.record))
    return place


def _recordings(given: Sequence[GivenSource]) -> Source:
    """Open recordings as one; those with the same name, or without, are one already.

    Raises:
        SourceError: one of them cannot be opened.
    """
    from sambot_viz.sources.bag import open_recording
    from sambot_viz.sources.bag.beside import Beside, beside_each_other
    from sambot_viz.sources.playback import RecordingPlayback

    groups: dict[tuple[str, str], list[GivenSource]] = {}
    for one in given:
        groups.setdefault((one.name, one.prefix), []).append(one)
    opened: list[Beside] = []
    for (name, prefix), parts in groups.items():
        called = parts[0].label if len(parts) == 1 else f"{len(parts)} recordings"
        recording = open_recording([part.path for part in parts])
        # Large files without an index are read through now: a second or two for a GB.
        while not recording.index_more():
            pass
        opened.append(Beside(recording, name or called, prefix, given[0].remaps))
    name = " and ".join(one.name for one in opened)
    only = opened[0]
    if len(opened) == 1 and not given[0].is_renamed:
        return RecordingPlayback(only.bag, name)
    return RecordingPlayback(beside_each_other(opened), name)


def refuse_time_of_live(options: Options) -> None:
    """Refuse to look at a time of a robot that is live.

    Raises:
        UsageError: the options name such a robot, and a time.
    """
    if options.at is not None and options.live_sources == options.sources:
        raise UsageError(
            "--at is a time of a recording; of a live robot the last messages are shown"
        )


def named_descriptions(config: Document | RvizConfig | None) -> tuple[str, ...]:
    """Return the topics of which a config wants robots, in its order.

    Args:
        config: as text or as a document; None for no topics.
    """
    from sambot_viz.rviz import RvizConfig
    from sambot_viz.rviz.yaml.yaml_nodes import Map, items_of

    if config is None:
        return ()
    if isinstance(config, RvizConfig):
        return tuple(_topics_of(display.node for display in config.displays))
    manager = config.root.get("Visualization Manager")
    items = manager.get("Displays") if isinstance(manager, Map) else None
    return tuple(_topics_of(display for _, display in items_of(items)))


def _topics_of(displays: Iterable[Map]) -> Iterator[str]:
    from sambot_viz.rviz.yaml.yaml_nodes import Map, Scalar, items_of

    for display in displays:
        if display.text("Enabled") == "false":
            continue
        yield from _topics_of(one for _, one in items_of(display.get("Displays")))
        topic = display.get("Description Topic")
        value = topic.get("Value") if isinstance(topic, Map) else topic
        is_file = display.text("Description Source") == "File"
        if isinstance(value, Scalar) and value.text and not is_file:
            yield f"/{value.text.removeprefix('/')}"
