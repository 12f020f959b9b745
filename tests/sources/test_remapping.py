"""Rules of ROS for names: which topics there are, under which names, and both ways."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path

import pytest
from live_peers import Inbox, LivePeer, eventually

from sambot_viz.moved_by import open_recorded
from sambot_viz.options import Options
from sambot_viz.sources.given import given_sources
from sambot_viz.sources.prefix import Prefix
from sambot_viz.sources.prefixed_source import PrefixedSource
from sambot_viz.sources.registry import open_source
from sambot_viz.sources.remapping import remaps_of

STRING = "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("rules", "found"),
    [
        (["/scan:=/a/scan"], {"/scan": "/a/scan"}),
        (["scan:=front/scan"], {"/scan": "/front/scan"}),
        (["/tf:=tf", "__ns:=/robot1"], {"/tf": "/robot1/tf"}),
        (["rviz2:a:=b", "rviz:c:=d", "other:e:=f"], {"/a": "/b", "/c": "/d"}),
        (["__node:=me", "__name:=me"], {}),
        (["~/a:=b"], {"/rviz/a": "/b"}),
        (["/a:=/b", "/a:=/c"], {"/a": "/c"}),
    ],
)
def test_rules_are_read_as_ros_reads_them(
    rules: Sequence[str], found: Mapping[str, str]
) -> None:
    assert remaps_of(rules) == found


def test_names_go_there_and_back() -> None:
    names = Prefix("", {"/scan": "/a/scan"})
    assert (names.outer("/a/scan"), names.inner("/scan")) == ("/scan", "/a/scan")
    # The topic of that name is not to be reached, as in ROS.
    assert names.outer("/other") == "/other"
    both = Prefix("b", {"/scan": "/b/front"})
    assert (both.outer("/front"), both.inner("/scan")) == ("/scan", "/front")


def test_a_live_topic_has_its_new_name_for_all_directions(
    peer: LivePeer, inbox: Inbox
) -> None:
    for topic in ("/a/said", "/said", "/plain"):
        peer.advertise(topic)
    source = PrefixedSource(open_source(peer.uri), "", {"/said": "/a/said"})
    source.open()
    try:
        eventually(lambda: set(source.topics()) >= {"/said", "/plain"})
        assert "/a/said" not in source.topics()
        source.subscribe("/said", inbox)
        eventually(lambda: peer.subscribed() == ["/a/said"])
        peer.publish("/said", "wrong")
        peer.publish("/a/said", "right")
        inbox.wait_for("right")
        assert {one.topic for one in inbox.messages} == {"/said"}
        outgoing = source.advertise("/said", STRING)
        eventually(lambda: peer.advertised() == [("/a/said", STRING)])
        outgoing.close()
    finally:
        source.close()


def test_a_recording_has_new_names_too(repository: Path) -> None:
    path = repository / "assets" / "square.mcap"
    given = given_sources([str(path)], {}, {"/wheels": "/joint_states"})
    with closing(open_recorded(Options(), given)) as moved_by:
        topics = moved_by.source.topics()
        assert "/wheels" in topics and "/joint_states" not in topics
