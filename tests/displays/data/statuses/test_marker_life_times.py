"""Markers are seen for as long as those that were watched in the real RViz."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest
import yaml
from inside import session_of
from made_recording import Message, write_messages
from quick_yaml import quick_yaml
from situations import START_NS, good_message
from status_world import transforms
from visible_steps import steps_to

from sambot_viz import Visualizer

RECORDED: Mapping[str, Sequence[float]] = quick_yaml(
    Path(__file__).parent / "statuses.yaml"
)["marker_life_times"]
END_S, STEP_S = 8.0, 0.1
BEFORE_S = 2.5
"""So long before the markers the transforms begin [s]."""
OF_ANOTHER = 'ADD at 6.0; DELETEALL with ns "another_ns" at 7.0'
ALL_GO = (7.0, {"action": 3, "ns": ""})
"""What ends those that stay."""
SENT: Mapping[str, Sequence[tuple[float, Mapping[str, Any]]]] = {
    "ADD at 0.50, stamp now, lifetime 2": [(0.5, {"lifetime": 2})],
    "ADD at 0.50, stamp 2 s OLD, lifetime 2": [(0.5, {"lifetime": 2, "ahead": -2})],
    "ADD at 0.50 without lifetime": [(0.5, {}), ALL_GO],
    "ADD at 0.50 lifetime 2, ADD again at 2.0 lifetime 2": [
        (0.5, {"lifetime": 2}),
        (2.0, {"lifetime": 2}),
    ],
    "ADD at 0.50, stamp 3 s AHEAD of TF, lifetime 2": [
        (0.5, {"lifetime": 2, "ahead": 3})
    ],
    "ADD at 0.50 lifetime 2, ADD again at 1.5 without lifetime": [
        (0.5, {"lifetime": 2}),
        (1.5, {}),
        ALL_GO,
    ],
    "ADD at 0.50, DELETE at 3.0": [(0.5, {}), (3.0, {"action": 2})],
    OF_ANOTHER: [(6.0, {}), (7.0, {"action": 3, "ns": "another_ns"})],
    "action 1": [(0.5, {"action": 1})],
}
"""Each case → when markers are sent [s], and what they say.

Their namespace is the topic, their stamp so far ahead of the time [s].
"""


def _markers(store: Any, topic: str, case: str) -> list[Message]:
    made: list[Message] = []
    for seconds, said in SENT[case]:
        marker = good_message(store, "Marker")
        marker.header.frame_id = "base_link"
        marker.ns, marker.action = said.get("ns", topic), said.get("action", 0)
        marker.lifetime.sec = said.get("lifetime", 0)
        time = START_NS + round(seconds * 1e9)
        stamp = time + said.get("ahead", 0) * 10**9
        marker.header.stamp.sec, marker.header.stamp.nanosec = divmod(stamp, 10**9)
        made.append((topic, "visualization_msgs/msg/Marker", time, marker))
    return made


@pytest.fixture(scope="module")
def seen(
    tmp_path_factory: pytest.TempPathFactory,
) -> Mapping[str, Sequence[float]]:
    """Each case → when its marker was seen first, and when no longer [s]."""
    from rosbags.typesys import Stores, get_typestore

    store, folder = get_typestore(Stores.ROS2_JAZZY), tmp_path_factory.mktemp("life")
    topics = {f"/a{number}": case for number, case in enumerate(SENT)}
    messages = transforms(store, END_S, begin_s=-BEFORE_S)
    for topic, case in topics.items():
        messages += _markers(store, topic, case)
    messages.sort(key=lambda one: one[2])
    source = write_messages(folder / "messages.mcap", messages)
    shown = [
        {
            "Class": "rviz_default_plugins/Marker",
            "Name": topic,
            "Enabled": True,
            "Topic": {"Value": topic},
        }
        for topic in topics
    ]
    options = {"Fixed Frame": "map"}
    manager = {"Class": "", "Displays": shown, "Global Options": options}
    config = folder / "displays.rviz"
    config.write_text(yaml.safe_dump({"Visualization Manager": manager}))
    found: dict[str, list[float]] = {case: [] for case in SENT}
    with Visualizer(source=f"bag:{source}", config=config, port=0) as viz:
        displays = session_of(viz).scene.displays
        for time in steps_to(viz, END_S + BEFORE_S - 0.2, STEP_S):
            for display in displays:
                (namespaces,) = display.entries()
                counts = (namespaces.facts(name) for name in namespaces.names)
                if any(facts["Markers"] == "1" for facts in counts):
                    found[topics[display.config.name]].append(time - BEFORE_S)
    return {case: (at[0], at[-1] + STEP_S) if at else () for case, at in found.items()}


@pytest.mark.parametrize("case", SENT)
def test_a_marker_is_seen_as_long_as_in_rviz(
    case: str, seen: Mapping[str, Sequence[float]]
) -> None:
    expected = list(RECORDED[case])
    if case == OF_ANOTHER:
        # RViz 2 deletes those of that namespace only.
        expected[1] = END_S
    assert seen[case] == pytest.approx(expected, abs=0.15)


def test_all_cases_are_looked_at() -> None:
    assert set(SENT) == set(RECORDED)
