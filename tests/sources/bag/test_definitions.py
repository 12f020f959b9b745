"""Definitions of a database that lie under another name than their type's."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from any_recording import DB3_TABLES

from sambot_viz.messages import Schema
from sambot_viz.sources.bag import open_recording


def test_the_event_of_a_service_has_the_definition_of_the_service(
    tmp_path: Path,
) -> None:
    path = tmp_path / "events.db3"
    with sqlite3.connect(path) as base:
        base.executescript(
            DB3_TABLES
            + """
            insert into topics values (1, '/a/_service_event',
                'std_srvs/srv/Trigger_Event', 'cdr', '');
            insert into topics values (2, '/b', 'lab/msg/Some_Event', 'cdr', '');
            insert into messages values (1, 1, 5, x'00010000');
            insert into message_definitions values (1, 'std_srvs/srv/Trigger',
                'ros2msg', '---' || char(10) || 'bool success' || char(10), '');
            """
        )
    base.close()
    with open_recording(path) as recording:
        schemas = [topic.schema for topic in recording.topics.values()]
    text = "---\nbool success\n"
    assert schemas == [
        Schema("std_srvs/srv/Trigger_Event", "ros2msg", text),
        Schema("lab/msg/Some_Event"),
    ]
