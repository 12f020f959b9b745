"""Compare topics that robot_localization and Nav2 read with published topics."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.parameters.copied_inputs import is_copied
from sambot_viz.checks.around.parameters.navigation import is_open
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.system import Endpoint, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest

_FILTERED = "odometry/filtered"
_COMMANDS = frozenset({"Twist", "TwistStamped"})
"""Types whose publishers users often start by hand."""


class Published(NamedTuple):
    """A topic in ROS.

    Attributes:
        topic: its name, with its place.
        kind: its type, without the package.
        what: its publisher.
        is_simulated: it comes from Gazebo, not from a node that reads others.
    """

    topic: Fact
    kind: str
    what: str
    is_simulated: bool


class ReadTopic(NamedTuple):
    """A topic that a node subscribes to because a parameter names it.

    Attributes:
        node: the node.
        end: its subscription.
        name: the topic, without a slash before it.
    """

    node: RunningNode
    end: Endpoint
    name: str

    @property
    def reader(self) -> str:
        """The node, as a file with parameters names it."""
        return self.node.path.strip("/")


def unknown_topics(around: Surroundings) -> Iterator[Problem]:
    """Report topics with different names at the publisher and the subscriber."""
    published = list(published_topics(around))
    used = used_topics(around)
    renamed = {u.end.message: p for p, u in _renamed(around, used, published)}
    yield from renamed.values()
    for one in used:
        name, kind = one.name, one.end.message
        if any(bare(p.topic.value) == name for p in published):
            # The topic exists; another rule checks its type.
            continue
        known = {
            bare(p.topic.value): p
            for p in published
            # A node does not read its own topics.
            if p.kind == kind and p.what != one.reader
        }
        if not known or is_open(name) or name == _FILTERED or kind in _COMMANDS:
            continue
        if any(other.name in known for other in used if _same(other, one)):
            # Another file fits this simulation; this one is for another robot.
            continue
        if around.said_elsewhere(name, as_topic=True) or _of_a_node(around, name):
            continue
        near = meant_topic(name, known) or _only(known, around)
        if near is not None and kind not in renamed:
            yield _unknown(one, known[near])


def _unknown(read: ReadTopic, source: Published) -> Problem:
    end, inside = read.end, ""
    if bare(end.written) != read.name:
        is_renamed = read.node.namespace in ("", "/")
        by = "a remapping" if is_renamed else "its namespace"
        inside = f", which is {end.topic} by {by},"
    return Problem.at(
        end.place,
        "warning",
        "topic-unknown",
        f"{read.reader} reads {end.written}{inside or ','} but {source.what} "
        f"publishes this {end.message} as {source.topic.value} "
        f"({where(source.topic.place, end.place)})",
        write(end.place, end.written, source.topic.value),
    )


def _only(known: Mapping[str, Published], around: Surroundings) -> str | None:
    """Return the only topic of a type, when no other node can publish one."""
    alone = len(known) == 1 and around.simulates_only_known
    return next((k for k, p in known.items() if alone and p.is_simulated), None)


def _renamed(
    around: Surroundings, used: Sequence[ReadTopic], published: Sequence[Published]
) -> Iterator[tuple[Problem, ReadTopic]]:
    """Report entries of a bridge whose topic all nodes read under its Gazebo name."""
    names = {bare(p.topic.value) for p in published}
    for entry in around.bridged:
        gz, ros = bare(entry.gz.value), entry.ros
        kind = entry.ros_type.value.rpartition("/")[2]
        readers = [u for u in used if u.end.message == kind]
        agree = all(u.name == gz for u in readers)
        if len(readers) < 2 or not agree or gz in names or gz == bare(ros.value):
            continue
        elsewhere = around.said_elsewhere(gz, as_topic=True, launched=True)
        if elsewhere or not entry.reaches_ros:
            continue
        first = readers[0]
        problem = Problem.at(
            ros.place,
            "warning",
            "topic-unknown",
            f"the bridge publishes this {kind} as {ros.value}, but {first.reader} "
            f"({where(first.end.place, ros.place)}) and all others read "
            f"{first.end.written}",
            write(ros.place, ros.value, f"/{gz}"),
        )
        yield problem, first


def _of_a_node(around: Surroundings, topic: str) -> bool:
    """Return whether a topic is below the name of a node with unknown topics."""
    owner = topic.rpartition("/")[0]
    running = around.running.started
    if any(bare(node.path) == owner and node.endpoints_known for node in running):
        return False
    nodes = {
        part for file in around.yaml_files for n in file.nodes for part in n.split("/")
    }
    if around.simulates_only_known:
        return owner in nodes
    return bool(owner) and (owner in nodes or around.said_elsewhere(owner))


def _same(one: ReadTopic, other: ReadTopic) -> bool:
    """Return whether another file has the same setting of the same node."""
    same = one.reader == other.reader and one.end.parameter == other.end.parameter
    return same and one is not other


def meant_topic(name: str, known: Mapping[str, Published]) -> str | None:
    """Return the intended topic: the same one below another name, or a similar one."""
    last = name.rpartition("/")[2]
    same = [k for k in known if k.rpartition("/")[2] == last]
    below = [k for k in known if k.startswith(f"{name}/")]
    return next(iter((*same, *below)), None) or nearest(name, known)


def used_topics(around: Surroundings) -> list[ReadTopic]:
    """Return the topics that nodes read because parameters name them.

    With namespaces, return only those of nodes that surely start in one, and of types
    that no other node publishes.
    """
    lost = {
        end.message
        for node in around.running.started
        for end in node.endpoints
        if end.publishes and not end.in_gazebo and not is_placed(around, node)
    }
    named = {
        (node.path, end.parameter, end.place): ReadTopic(node, end, bare(end.topic))
        for node in around.running.started
        for end in node.endpoints
        if end.parameter and not end.publishes and not end.in_gazebo and end.kind
        if is_placed(around, node) and not is_copied(around, end.place)
    }
    return [read for read in named.values() if read.end.message not in lost]


def is_placed(around: Surroundings, node: RunningNode) -> bool:
    """Return whether the namespace of a node is known."""
    return not around.namespaced or (node.starts == "yes" and node.namespace != "")


def published_topics(around: Surroundings) -> Iterator[Published]:
    """Yield the topics in ROS that nodes, bridges and plugins publish."""
    plugins = {plugin.filename for plugin in around.plugins}
    for node in around.running.started:
        what = node.path.strip("/")
        is_simulated = node.is_bridge or node.executable in plugins
        if is_simulated:
            what = "the bridge" if node.is_bridge else f"the plugin {node.executable}"
        for end in node.endpoints if is_placed(around, node) else ():
            if end.publishes and not end.in_gazebo:
                topic = Fact(end.topic, end.place)
                yield Published(topic, end.message, what, is_simulated)
