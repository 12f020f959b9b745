"""A graph as SVG, DOT and JSON: what is drawn, marked, escaped and left out."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from lower_limit import lower

from sambot_viz.errors import Problem
from sambot_viz.graph.drawing import graph_dot, graph_json_text
from sambot_viz.graph.node_graph import (
    GraphEdge,
    GraphNode,
    GraphTopic,
    NodeGraph,
    compared,
    node_graph,
)
from sambot_viz.graph.placed_graph import PlacedPart, place_graph
from sambot_viz.graph.svg import graph_svg

ODOMETRY = "nav_msgs/msg/Odometry"
WRONG = Problem("error", "topic-unknown", "nobody publishes /odom", "write /wheel/odom")


def small_graph() -> NodeGraph:
    return node_graph(
        [
            GraphNode("/ekf", package="robot_localization", file="a.py", line=4),
            GraphNode("/front/scanner", is_certain=False),
        ],
        [GraphTopic("/odom", types=(ODOMETRY,), problem=WRONG)],
        [
            GraphEdge("/ekf", "/odom", "subscribes", remapped_from="odom0"),
            GraphEdge("/ekf", "/map", "subscribes"),
            GraphEdge("/front/scanner", "/front/scan", "publishes"),
        ],
    )


def parts(graph: NodeGraph) -> dict[str, PlacedPart]:
    return {part.name: part for part in place_graph(graph).parts}


def test_a_topic_with_a_finding_is_red_and_says_it() -> None:
    found = parts(small_graph())
    assert found["/odom"].lines == (
        "/odom",
        "nav_msgs/Odometry",
        "error: topic-unknown",
    )
    assert "error" in found["/odom"].look
    assert "nobody publishes /odom" in found["/odom"].said
    assert "To fix it: write /wheel/odom" in found["/odom"].said
    assert found["/map"].look == ("topic", "unwritten")
    assert found["/front/scan"].look == ("topic",)
    assert found["/front/scanner"].look == ("node", "uncertain")


def test_what_nobody_is_known_to_publish_is_not_red_where_more_may_start() -> None:
    found = node_graph((), (), [GraphEdge("/a", "/map", "subscribes")], is_whole=False)
    assert parts(found)["/map"].look == ("topic", "uncertain")
    assert "no node that is known publishes it" in parts(found)["/map"].said


def test_a_namespace_with_nodes_has_a_box_around_them() -> None:
    placed = place_graph(small_graph())
    (space,) = placed.spaces
    assert space.name == "/front"
    inside = {
        part.name
        for part in placed.parts
        if space.x < part.x - part.width / 2
        and part.x + part.width / 2 < space.x + space.width
        and space.y < part.y - part.height / 2
        and part.y + part.height / 2 < space.y + space.height
    }
    assert inside == {"/front/scanner", "/front/scan"}
    assert 0 < space.x and space.x + space.width < placed.width
    assert 0 < space.y and space.y + space.height < placed.height


def test_without_details_names_are_left_and_topics_that_nodes_share() -> None:
    graph = node_graph(
        [GraphNode("/talker", package="demo")],
        [GraphTopic("/bad", problem=WRONG), GraphTopic("/b", types=(ODOMETRY,))],
        [
            GraphEdge("/talker", "/a", "publishes"),
            GraphEdge("/talker", "/bad", "publishes"),
            GraphEdge("/talker", "/b", "publishes"),
            GraphEdge("/listener", "/b", "subscribes"),
            GraphEdge("/listener", "/unwritten", "subscribes"),
        ],
    )
    lines = {part.name: part.lines for part in place_graph(graph, details=False).parts}
    assert lines == {
        "/listener": ("/listener",),
        "/talker": ("/talker",),
        "/b": ("/b",),
        "/bad": ("/bad", "error: topic-unknown"),
        "/unwritten": ("/unwritten",),
    }


def test_what_nothing_leads_to_is_in_rows_below_the_rest() -> None:
    single = [GraphNode(f"/single_{i:02}") for i in range(20)]
    edges = [GraphEdge("/a", "/b", "publishes")]
    placed = place_graph(node_graph(single, (), edges))
    of = {part.name: part for part in placed.parts}
    rows = {of[node.name].y for node in single}
    assert 1 < len(rows) < 10 and min(rows) > max(of["/a"].y, of["/b"].y)
    for part in placed.parts:
        assert 0 < part.x - part.width / 2 < part.x + part.width / 2 < placed.width
        assert 0 < part.y - part.height / 2 < part.y + part.height / 2 < placed.height


def test_the_picture_leads_to_launch_files_and_says_what_is_remapped() -> None:
    drawn = graph_svg(small_graph(), Path("pictures"))
    root = ElementTree.fromstring(drawn)
    links = [one.get("href") for one in root.iter("{http://www.w3.org/2000/svg}a")]
    assert links == ["../a.py#L4"]
    assert "/ekf subscribes to /odom, which it calls odom0" in drawn
    assert "<a " not in graph_svg(small_graph())


def test_what_was_expected_and_does_not_run_is_marked() -> None:
    running = node_graph(
        (),
        [GraphTopic("/map", "running", ("nav_msgs/msg/OccupancyGrid",))],
        [
            GraphEdge("/ekf", "/map", "subscribes", "running"),
            GraphEdge("/map_server", "/map", "publishes", "running"),
        ],
    )
    expected = small_graph()
    nodes = {**expected.nodes, "/front/scanner": GraphNode("/front/scanner")}
    both = compared(replace(expected, nodes=nodes), running)
    states = {name: part.look[1] for name, part in parts(both).items()}
    assert states == {
        "/ekf": "both",
        "/front/scanner": "expected",
        "/map_server": "running",
        "/odom": "expected",
        "/front/scan": "expected",
        "/map": "both",
    }
    assert "unwritten" not in parts(both)["/map"].look
    said = json.loads(graph_json_text(both))
    edges = {(e["node"], e["topic"]): e["state"] for e in said["edges"]}
    assert edges["/ekf", "/map"] == "both"
    assert edges["/map_server", "/map"] == "running"
    assert edges["/ekf", "/odom"] == "expected"
    types = {topic["name"]: topic["types"] for topic in said["topics"]}
    assert types["/map"] == ["nav_msgs/msg/OccupancyGrid"]
    assert "style=dashed" in graph_dot(both)


@pytest.mark.parametrize(
    ("node", "topic"),
    [
        (GraphNode("/amcl", is_certain=False), "/scan"),
        (GraphNode("/create", executable="create"), "/robot_description"),
        (GraphNode("/gazebo", executable="gzserver"), None),
    ],
)
def test_what_need_not_run_is_not_missed(node: GraphNode, topic: str | None) -> None:
    edges = [GraphEdge(node.name, topic, "subscribes")] if topic else []
    running = node_graph((), (), [GraphEdge("/a", "/b", "publishes", "running")])
    both = compared(node_graph([node], (), edges), running)
    assert ([*both.nodes], [*both.topics]) == (["/a"], ["/b"])
    assert both.notes == (f"may run, and does not: {node.name}",)
    there = compared(node_graph([node], (), edges), node_graph([node], (), edges))
    assert there.nodes[node.name].presence == "both"


def test_where_nodes_are_not_known_to_run_only_topics_are_missed() -> None:
    topics = [GraphTopic("/odom", "running")]
    running = node_graph((), topics, (), is_whole=False)
    looks = {n: p.look for n, p in parts(compared(small_graph(), running)).items()}
    assert looks["/ekf"] == ("node",)
    assert looks["/front/scanner"] == ("node", "uncertain")
    assert looks["/odom"][1] == "both"
    assert looks["/map"][1] == "expected"


def test_json_has_what_is_known() -> None:
    said = json.loads(graph_json_text(small_graph()))
    (ekf, scanner) = said["nodes"]
    assert (ekf["package"], ekf["file"], ekf["line"]) == (
        "robot_localization",
        "a.py",
        4,
    )
    assert (scanner["package"], scanner["certain"]) == (None, False)
    odom = next(topic for topic in said["topics"] if topic["name"] == "/odom")
    assert odom["unwritten"] and odom["problem"]["code"] == "topic-unknown"
    assert said["edges"][1]["remapped_from"] == "odom0"


def test_dot_tells_a_node_from_a_topic_with_its_name() -> None:
    drawn = graph_dot(node_graph((), (), [GraphEdge("/a/b", "/a/b", "publishes")]))
    assert '"node /a/b" -> "topic /a/b";' in drawn
    assert "subgraph cluster_0" in drawn


def test_logs_and_parameters_of_every_node_are_left_out_as_in_rqt_graph() -> None:
    graph = node_graph(
        (),
        (),
        [
            GraphEdge("/a", "/rosout", "publishes"),
            GraphEdge("/a", "/parameter_events", "subscribes"),
            GraphEdge("/a", "/scan", "publishes"),
            GraphEdge("/a", "/dock/_action/status", "publishes"),
            GraphEdge("/transform_listener_impl_5f", "/tf", "subscribes"),
        ],
    ).without_hidden()
    assert [*graph.nodes] == ["/a"]
    assert [edge.topic for edge in graph.edges] == ["/scan"]
    assert "/rosout" not in graph.topics


def test_a_graph_that_is_too_large_says_what_is_left_out(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    lower(monkeypatch, "GRAPH_EDGES", 2)
    placed = place_graph(small_graph())
    assert len(placed.edges) == 2
    assert placed.notes == ("1 arrows are not drawn; the limit is 2",)
    lower(monkeypatch, "GRAPH_PARTS", 3)
    placed = place_graph(small_graph())
    assert len(placed.parts) == 3
    assert placed.notes[0] == "2 more nodes and topics; the first 3 are drawn"


def test_nothing_is_drawn_as_a_sentence() -> None:
    assert "no node and no topic is known" in graph_svg(NodeGraph())
