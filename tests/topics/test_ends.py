"""Who publishes a topic and who subscribes to it, and which of them get nothing."""

from __future__ import annotations

import pytest

from sambot_viz.messages import Schema
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.qos import Qos
from sambot_viz.sources.ros_endpoint import Kind, RosEndpoint, TopicEndpoints
from sambot_viz.sources.ros_graph import NO_HASH
from sambot_viz.topics.ends import MOST_ENDS, ends_of

SCAN = "sensor_msgs/msg/LaserScan"
LOOSE, SAFE = Qos("best_effort", "volatile"), Qos("reliable", "volatile")
KEPT = Qos("reliable", "transient_local")


def end(
    kind: Kind, node: str, qos: Qos, type_name: str = SCAN, type_hash: str = ""
) -> RosEndpoint:
    return RosEndpoint(kind, node, "/scan", type_name, type_hash, qos)


def topic(
    publishers: list[RosEndpoint],
    subscribers: list[RosEndpoint],
    matches_qos: bool = True,
) -> SourceTopic:
    ends = TopicEndpoints((*publishers,), (*subscribers,), matches_qos)
    return SourceTopic("/scan", Schema(SCAN), "cdr", endpoints=ends)


def trouble(
    publisher: RosEndpoint, subscriber: RosEndpoint, matches_qos: bool = True
) -> str:
    made = topic([publisher], [subscriber], matches_qos)
    offering, asking = ends_of(made)
    assert offering.trouble == ""
    return asking.trouble


@pytest.mark.parametrize(
    ("offered", "wanted", "words"),
    [
        (LOOSE, SAFE, "offers Best Effort, and it wants Reliable: change the reliab"),
        (SAFE, KEPT, "offers Volatile, and it wants Transient Local: change the dura"),
        (SAFE, LOOSE, ""),
        (KEPT, SAFE, ""),
        (Qos(), KEPT, ""),
    ],
)
def test_a_subscriber_that_asks_for_more_gets_nothing(
    offered: Qos, wanted: Qos, words: str
) -> None:
    lidar, costmap = (
        end(Kind.PUBLISHER, "/lidar", offered),
        end(Kind.SUBSCRIBER, "/costmap", wanted),
    )
    said = trouble(lidar, costmap)
    assert said.startswith("gets nothing from /lidar, which" if words else "")
    assert words in said
    # rmw_zenoh hands on what is published with any QoS.
    assert trouble(lidar, costmap, matches_qos=False) == ""


def test_nodes_with_two_definitions_or_types_are_told_apart() -> None:
    lidar = end(Kind.PUBLISHER, "/lidar", SAFE, type_hash="RIHS01_aa")
    old = end(Kind.SUBSCRIBER, "/old", SAFE, type_hash="RIHS01_bb")
    assert "another definition of sensor_msgs/msg/LaserScan" in trouble(lidar, old)
    assert "the same version of sensor_msgs" in trouble(lidar, old)
    humble = end(Kind.SUBSCRIBER, "/humble", SAFE, type_hash=NO_HASH)
    assert trouble(lidar, humble) == ""
    other = end(Kind.SUBSCRIBER, "/other", SAFE, "std_msgs/msg/String")
    assert "which publishes sensor_msgs/msg/LaserScan" in trouble(lidar, other)


def test_a_node_is_said_with_its_qos_and_its_trouble() -> None:
    said = [*map(str, ends_of(topic([end(Kind.PUBLISHER, "/lidar", LOOSE)], [])))]
    assert said == ["/lidar (Best Effort, Volatile)"]
    unnamed = end(Kind.PUBLISHER, "", LOOSE)
    listening = end(Kind.SUBSCRIBER, "/li\nar", SAFE)
    first, second = map(str, ends_of(topic([unnamed], [listening])))
    assert first == "an unnamed program (Best Effort, Volatile)"
    assert "\n" not in second


def test_where_only_names_are_said_they_are_told() -> None:
    made = SourceTopic(
        "/scan", Schema(SCAN), "cdr", publishers=("/a",), subscribers=("/b",)
    )
    assert [(one.node, one.publishes) for one in ends_of(made)] == [
        ("/a", True),
        ("/b", False),
    ]
    counted = SourceTopic("/scan", Schema(SCAN), "cdr", publishers=3)
    assert [*ends_of(counted)] == []


def test_thousands_of_them_are_cut() -> None:
    many = [end(Kind.PUBLISHER, f"/{n}", SAFE) for n in range(3 * MOST_ENDS)]
    others = [end(Kind.SUBSCRIBER, f"/{n}", SAFE) for n in range(3 * MOST_ENDS)]
    assert len([*ends_of(topic(many, others))]) == 2 * MOST_ENDS
