"""What launch files start as a graph, with the findings of check at its parts."""

from __future__ import annotations

from sambot_viz.checks.around.running import (
    Endpoint,
    RunningNode,
    RunningSystem,
    UnknownStart,
)
from sambot_viz.checks.around.running.system import Starts
from sambot_viz.errors import Place, Problem
from sambot_viz.graph.expected import expected_graph

LAUNCH, PARAMETERS = "launch/all.launch.py", "config/ekf.yaml"


def a_node(
    name: str,
    line: int,
    *ends: Endpoint,
    starts: Starts = "yes",
    remappings: tuple[tuple[str, str], ...] = (),
) -> RunningNode:
    return RunningNode(
        "pack",
        name,
        name,
        "/",
        starts,
        (),
        True,
        remappings,
        (),
        Place(LAUNCH, line),
        endpoints=ends,
        endpoints_known=True,
    )


def an_end(topic: str, line: int, *, publishes: bool = False) -> Endpoint:
    kind = "nav_msgs/msg/Odometry"
    written = topic.removeprefix("/")
    return Endpoint(topic, kind, publishes, Place(PARAMETERS, line), written)


def test_a_finding_is_at_the_topic_of_its_line_or_that_it_names() -> None:
    system = RunningSystem(
        nodes=(a_node("ekf", 3, an_end("/odom", 7), an_end("/wheels", 9)),)
    )
    at_line = Problem("error", "a", "nobody sends it", file=PARAMETERS, line=7)
    by_name = Problem("warning", "b", "two send /wheels/left, /wheels", file="x.urdf")
    at_node = Problem("info", "c", "it has no name", file=LAUNCH, line=3)
    elsewhere = Problem("info", "d", "/wheels2 is odd", file=LAUNCH, line=99)
    graph = expected_graph(system, [at_line, by_name, at_node, elsewhere])
    assert graph.topics["/odom"].problem == at_line
    assert graph.topics["/wheels"].problem == by_name
    assert graph.nodes["/ekf"].problem == at_node
    other = Problem(
        "error", "a", "ekf reads odom, not /wheels", file=PARAMETERS, line=7
    )
    graph = expected_graph(system, [other])
    assert [t.name for t in graph.topics.values() if t.problem] == ["/odom"]
    assert graph.unwritten() == {"/odom", "/wheels"}
    assert graph.is_whole


def test_a_remapped_topic_has_the_name_that_the_node_calls_it() -> None:
    end = Endpoint("/wheels", "", True, Place(LAUNCH, 3), "odom")
    remapped = a_node("base", 3, end, remappings=(("odom", "/wheels"),))
    (edge,) = expected_graph(RunningSystem(nodes=(remapped,))).edges
    assert (edge.topic, edge.direction, edge.remapped_from) == (
        "/wheels",
        "publishes",
        "odom",
    )


def test_of_nodes_with_one_name_that_which_starts_is_drawn() -> None:
    one = a_node("bridge", 3, an_end("/scan", 1, publishes=True))
    other = a_node("bridge", 8, an_end("/imu", 2, publishes=True), starts="unknown")
    graph = expected_graph(RunningSystem(nodes=(one, other)))
    assert graph.nodes["/bridge"].is_certain
    assert graph.nodes["/bridge"].line == 3
    assert [*graph.topics] == ["/imu", "/scan"]
    assert graph.notes == ()
    twice = expected_graph(RunningSystem(nodes=(one, one)))
    assert twice.notes == ("/bridge is started 2 times, and drawn once",)


def test_where_more_may_start_is_said_and_nothing_is_certain() -> None:
    unknown = tuple(UnknownStart(f"part {i}", Place(LAUNCH, i)) for i in range(5))
    off = a_node("off", 9, starts="no")
    graph = expected_graph(RunningSystem(nodes=(off,), unknown=unknown))
    assert not graph.is_whole
    assert [*graph.nodes] == []
    assert graph.notes[0] == f"more may start: part 0 ({LAUNCH}:0)"
    assert graph.notes[-1] == "and at 2 other places"


def test_topics_of_gazebo_alone_are_none_of_the_graph() -> None:
    inside = Endpoint("/scan", "gz.msgs.Scan", True, Place("w.sdf", 1), in_gazebo=True)
    graph = expected_graph(RunningSystem(nodes=(a_node("gazebo", 3, inside),)))
    assert [*graph.topics] == []


def test_a_finding_below_the_line_of_a_node_is_at_the_node_that_it_names() -> None:
    nodes = (a_node("talker", 3), a_node("listener", 9))
    named = Problem("error", "a", "pack has no program talker", file=LAUNCH, line=5)
    other = Problem("error", "b", "the argument x is not there", file=LAUNCH, line=11)
    graph = expected_graph(RunningSystem(nodes=nodes), [other, named])
    found = {name: node.problem for name, node in graph.nodes.items()}
    assert found == {"/talker": named, "/listener": None}
