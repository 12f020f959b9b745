"""``sambot-viz topics``: list topics, and explain why one shows nothing."""

from __future__ import annotations

import os.path
from collections.abc import Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import asdict
from operator import attrgetter
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.errors import Problem, UsageError
from sambot_viz.files import LIVE_SOURCES
from sambot_viz.moved_by import open_moved_by, refuse_mixture, refuse_time_of_live
from sambot_viz.options import Options
from sambot_viz.outlet import write_err, write_json, write_lines
from sambot_viz.problems import write_problems
from sambot_viz.sources.message import SourceTopic
from sambot_viz.text import text
from sambot_viz.topics import reasons
from sambot_viz.topics.account import Account
from sambot_viz.topics.ends import ends_of
from sambot_viz.topics.report import TopicReport
from sambot_viz.topics.source_robot import SourceRobot
from sambot_viz.topics.survey import Survey
from sambot_viz.topics.transforms import problems_of_transforms

if TYPE_CHECKING:
    from sambot_viz.listened import Listened

_NONE: Mapping[str, SourceTopic] = MappingProxyType({})
_HEAD = ("TOPIC", "TYPE", "COUNT", "RATE", "REASON")
_WIDEST = 60
_SENTENCE = 2000
"""Of a sentence: the remedy is at its end."""


def run(words: list[str]) -> int:
    """Print the topics of recordings or of a live robot; 1 when errors were found."""
    given, options = parse(parser(), words)
    statuses, found, topics = _looked_at(options, given.listen)
    if options.model is not None:
        found = [p for p in found if p.code != "no-description"]
    # "No messages" already explains it.
    if any(problem.severity == "error" for problem in found):
        found = [p for p in found if p.severity == "error"]
    write_problems(found, most=None)
    if given.format == "json":
        write_json({"topics": [topic_json(row, topics) for row in statuses]})
    else:
        write_lines(f"{topics_text(statuses, topics)}\n")
    return int(any(problem.severity == "error" for problem in found))


def _looked_at(
    options: Options, seconds: float
) -> tuple[list[Account], list[Problem], Mapping[str, SourceTopic]]:
    """Return the account of each topic, the problems, and a robot's topics."""
    refuse_time_of_live(options)
    refuse_mixture(options)
    moved_by = open_moved_by(options)
    if moved_by is None:
        raise UsageError(_no_recording(options))
    if moved_by.recording is None:
        # The import is late: a recording needs no network.
        from sambot_viz.listened import Listened

        with closing(Listened(moved_by, seconds, None)) as listened:
            return *_of_live(listened), listened.topics
    with closing(moved_by):
        if not any(one.name for one in moved_by.given):
            _say_together(moved_by.recording.paths)
        return *_of_recording(moved_by, moved_by.at_ns), _NONE


def _say_together(paths: Sequence[Path]) -> None:
    """Report which files form one recording, where rosbag2's metadata is missing."""
    if len(paths) < 2 or all(
        (path.parent / "metadata.yaml").is_file() for path in paths
    ):
        return
    names = ", ".join(text(path.name, _WIDEST) for path in paths)
    write_err(
        f"sambot-viz: note: {len(paths)} files are counted as one recording: {names}; "
        "give one of them to list it alone"
    )


def _no_recording(options: Options) -> str:
    if options.model is None:
        return (
            "name a recording: sambot-viz topics FILE.mcap (or .db3, .bag, or a "
            f"folder), or --source {LIVE_SOURCES} of a live robot"
        )
    if os.path.exists(str(options.model)):
        return f"'{options.model}' is not a recording: give an mcap, db3 or bag file"
    return f"'{options.model}' does not exist"


def _of_recording(
    recorded: SourceRobot, at_ns: int | None
) -> tuple[list[Account], list[Problem]]:
    survey = Survey(recorded)
    survey.finish()
    report = TopicReport(survey)
    report.at_ns = at_ns
    of_frames = problems_of_transforms(survey.transforms, recorded.name)
    found = dict.fromkeys((*recorded.problems, *of_frames))
    return list(report.accounts()), [*found]


def _of_live(listened: Listened) -> tuple[list[Account], list[Problem]]:
    """Return the same for a live robot: with topics of which no message came."""
    rows, found = list[Account](), list[Problem]()
    recorded = listened.recorded
    if recorded is not None:
        # At the end no message is still to come.
        end_ns = None if recorded.recording is None else recorded.recording.end_ns
        rows, found = _of_recording(recorded, end_ns)
    came = {row.name for row in rows}
    for name in sorted(listened.topics.keys() - came):
        topic = listened.topics[name]
        why = reasons.unreceived(topic) or reasons.nothing_came(listened.seconds)
        readable = topic.reason is None
        rows.append(Account(name, topic.schema.name, 0, None, readable, why))
    return sorted(rows, key=attrgetter("name")), [*listened.lost, *found]


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz topics",
        groups=("model", "source"),
        model="recording (see below)",
        description="List the topics of a recording or of a live robot: type, number "
        "and rate [Hz] of the messages, and why nothing of a topic is seen. Some of "
        "the first messages are decoded. Exit status: 0 listed, 1 errors found, "
        "2 usage.",
        epilog="MODEL is a recording: an mcap, db3 or ROS 1 bag file, or a folder that "
        "ros2 bag record made.",
    )
    made.add_listen()
    made.add_format()
    return made


def topic_json(row: Account, topics: Mapping[str, SourceTopic]) -> dict[str, Any]:
    """Return the fields of ``topics --format json``; `topics` are those of a robot."""
    reason, topic = row.reason, topics.get(row.name)
    return {
        "name": row.name,
        "type": row.type_name,
        "count": row.count,
        "rate": None if row.rate is None else round(row.rate, 3),
        "readable": row.readable,
        "reason": None if reason is None else reason.text,
        "code": None if reason is None else reason.code,
        "nodes": None if topic is None else [asdict(one) for one in ends_of(topic)],
    }


def topics_text(
    rows: Iterable[Account], topics: Mapping[str, SourceTopic] = _NONE
) -> str:
    """Return a table, without a line break at the end.

    Args:
        rows: its topics.
        topics: those of a robot; the nodes of each are listed below it.
    """
    rows = [*rows]
    cells = [_cells(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(_HEAD, *cells, strict=True)][:4]
    lines = [_line(_HEAD, widths)]
    for row, of_row in zip(rows, cells, strict=True):
        lines.append(_line(of_row, widths))
        if row.name in topics:
            lines += _of_nodes(topics[row.name])
    return "\n".join(lines)


def _of_nodes(topic: SourceTopic) -> Iterable[str]:
    for one in ends_of(topic):
        yield f"    {'publishes' if one.publishes else 'subscribes':<10}  {one}"


def _cells(row: Account) -> tuple[str, str, str, str, str]:
    reason = row.reason
    return (
        text(row.name, _WIDEST),
        text(row.type_name, _WIDEST) or "-",
        "?" if row.count is None else str(row.count),
        "-" if row.rate is None else f"{row.rate:.1f}",
        "" if reason is None else text(f"{reason.code}: {reason.text}", _SENTENCE),
    )


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    name, kind, count, rate, reason = cells
    wide, typed, counted, rated = widths
    line = f"{name:<{wide}}  {kind:<{typed}}  {count:>{counted}}  {rate:>{rated}}"
    return f"{line}  {reason}".rstrip()
