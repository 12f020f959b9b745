"""Compare topics of RViz displays and tools with what launch files start."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.misspelt import is_misspelt
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.displays import DisplayTopic, displays_of
from sambot_viz.checks.around.running.endpoints import whole_name
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.running.simulated import possible_node
from sambot_viz.checks.around.running.system import RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.read import (
    Published,
    meant_topic,
    published_topics,
)
from sambot_viz.checks.around.topics.two_types import two_types
from sambot_viz.checks.vocabulary import vocabulary
from sambot_viz.edits import write
from sambot_viz.errors import Fix, Place, Problem, Severity

_SENSED = frozenset("Image Imu LaserScan NavSatFix Odometry PointCloud2".split())
"""Types with few sources on a robot; nodes that start later also send others."""
_OF_SENSORS = frozenset("Imu LaserScan NavSatFix".split())
"""Types that hardly any node computes from other messages."""
_CARRIED = frozenset(kind.rpartition("/")[2] for kind in vocabulary("ros_gz_bridge"))
_MODEL = "String"
"""The type of robot descriptions, which the check of the config handles."""

Shown = Sequence[tuple[str, DisplayTopic]]
"""The displays of a config with the full names of their topics."""


def unseen_topics(around: Surroundings) -> Iterator[Problem]:
    """Report displays that get nothing, and tools whose topic nothing reads."""
    published = list(published_topics(around))
    sent = {topic.topic.value for topic in published}
    packages = {package.name: package for package in around.packages}
    done: set[Place] = set()
    for node in (*around.running.started, *_not_started(around)):
        known = known_nodes().nodes.get((node.package, node.executable))
        if known is None or not known.does("displays"):
            continue
        topics = [
            (whole_name(node, each.topic.value), each)
            for each in displays_of(node, packages.get)
        ]
        unsent = [t for t in topics if t[0] not in sent and not t[1].is_tool]
        yield from two_types(unsent)
        for whole, each in topics:
            if each.topic.place not in done and whole.startswith("/"):
                done.add(each.topic.place)
                yield from _wrong(around, node, whole, each, topics, published)


def _not_started(around: Surroundings) -> Iterator[RunningNode]:
    """Yield an RViz for each config that no launch file names."""
    said = {word for node in around.running.nodes for word in node.arguments if word}
    for package in around.packages:
        for path in package.ending(".rviz"):
            name, place = path.rpartition("/")[2], Place(package.shown(path), 1)
            if not any(word.endswith(name) for word in said):
                words = ("-d", f"{SHARE}{package.name}/{path}")
                node = possible_node("rviz2", "rviz2", "rviz2", "/", (), place)
                yield replace(node, arguments=words)


def _wrong(
    around: Surroundings,
    node: RunningNode,
    whole: str,
    each: DisplayTopic,
    others: Shown,
    published: Sequence[Published],
) -> Iterator[Problem]:
    if each.is_tool:
        yield from _of_tool(around, whole, each)
        return
    kind = _short(each.message)
    sources = [p for p in published if p.topic.value == whole]
    if kind == _MODEL:
        yield from _of_robot(around, node, whole, each, published)
        return
    if any(p.kind == kind for p in sources):
        yield from _volatile(around, node, whole, each)
        return
    if not sources:
        yield from _usually_once(each, bare(whole))
    fitting = [p for p in published if p.kind == kind]
    shown = {topic for topic, other in others if other is not each}
    if any(p.is_simulated and p.kind not in _CARRIED for p in sources):
        # No bridge has this type: another rule reports that.
        return
    if sources and sources[0].kind:
        free = [p for p in fitting if p.topic.value not in shown]
        yield _other_type(each, sources[0], free)
        return
    if sources:
        # A relay publishes a type that only its source decides on.
        return
    known = {bare(p.topic.value): p for p in fitting}
    near = _misspelt(bare(whole), known)
    is_only = near is None and node.starts == "yes"
    if is_only:
        near = _meant(around, bare(whole), kind, known, shown)
    is_guess = near is None
    if near is None and not around.namespaced and kind in _SENSED:
        near = _of_another_namespace(bare(whole), known)
    if near is not None and not around.said_elsewhere(bare(whole), as_topic=True):
        certain = not is_guess and (not is_only or around.running.is_known)
        yield _unpublished(each, known[near], "warning" if certain else "info")


def _short(message: str) -> str:
    return message.rpartition("/")[2]


def _misspelt(name: str, known: Mapping[str, Published]) -> str | None:
    """Return the published topic that a name misspells."""
    misspelt = (topic for topic in known if is_misspelt(name, topic))
    return None if any(map(str.isdigit, name)) else next(misspelt, None)


def _meant(
    around: Surroundings,
    name: str,
    kind: str,
    known: Mapping[str, Published],
    shown: set[str],
) -> str | None:
    """Return the intended published topic; None where others may be published.

    In a simulation, unknown nodes have no sensors.
    """
    is_known = around.running.is_known
    if not is_known and not (around.running.simulates and kind in _OF_SENSORS):
        return None
    if around.namespaced or kind not in _SENSED:
        return None
    free = {topic: p for topic, p in known.items() if f"/{topic}" not in shown}
    only = next(iter(free)) if len(free) == 1 else None
    return (meant_topic(name, free) or only) if is_known else only


def _of_another_namespace(name: str, known: Collection[str]) -> str | None:
    """Return the only topic of the type, if only its namespace is another one."""
    last = name.rpartition("/")[2]
    same = [topic for topic in known if topic.rpartition("/")[2] == last]
    return same[0] if len(known) == len(same) == 1 else None


def _unpublished(each: DisplayTopic, source: Published, severity: Severity) -> Problem:
    place = each.topic.place
    return Problem.at(
        place,
        severity,
        "topic-unknown",
        f"the display {each.name} reads {each.topic.value}, but {source.what} "
        f"publishes this {source.kind} as {source.topic.value} "
        f"({where(source.topic.place, place)}): it shows nothing",
        write(place, each.topic.value, source.topic.value),
    )


def _other_type(
    each: DisplayTopic, source: Published, fitting: Sequence[Published]
) -> Problem:
    """Report a topic of another type: either the class or the topic is wrong."""
    displays = known_nodes().displays.items()
    classes = [kind for kind, message in displays if _short(message) == source.kind]
    named = [kind for kind in classes if _short(kind) == each.name]
    if named or (classes and not fitting):
        place = each.kind.place
        fix = write(place, each.kind.value, (named or classes)[0])
    else:
        place = each.topic.place
        topics = [p.topic.value for p in fitting]
        fix = Fix(f"write {' or '.join(topics)}" if topics else "write another topic")
        fix = write(place, each.topic.value, topics[0]) if len(topics) == 1 else fix
    return Problem.at(
        place,
        "warning",
        "topic-type",
        f"the display {each.name} of the class {_short(each.kind.value)} takes "
        f"{_short(each.message)}, but {source.what} publishes {each.topic.value} as "
        f"{source.kind} ({where(source.topic.place, place)}): it shows nothing",
        fix,
    )


def _of_robot(
    around: Surroundings,
    node: RunningNode,
    whole: str,
    each: DisplayTopic,
    published: Sequence[Published],
) -> Iterator[Problem]:
    """Report a robot description in a namespace where nothing publishes it."""
    last = whole.rpartition("/")[2]
    sources = {
        p.topic.value: p
        for p in published
        if p.kind == _MODEL and p.topic.value.endswith(f"/{last}")
    }
    are_placed = all(other.namespace for other in around.running.started)
    if len(sources) != 1 or whole in sources or not are_placed:
        return
    ((right, source),) = sources.items()
    is_certain = node.starts == "yes" and around.running.is_whole
    place = each.topic.place
    yield Problem.at(
        place,
        "warning" if is_certain else "info",
        "setup-description-topic",
        f"the display {each.name} reads the robot from the topic {whole}, but "
        f"{source.what} publishes it on {right} ({where(source.topic.place, place)})",
        write(place, each.topic.value, right, hint=f"write Value: {right}"),
    )


def _usually_once(each: DisplayTopic, name: str) -> Iterator[Problem]:
    """Report a volatile topic that a well-known node publishes only once."""
    policy = each.policies.get("Durability Policy")
    if policy is None or policy.value != "Volatile":
        return
    for known in dict.fromkeys(known_nodes().nodes.values()):
        for row in known.rows:
            usual = row.words[0].rpartition("=")[2] if row.words else ""
            if row.latched == "once" and (usual, row.words[1]) == (name, each.message):
                follows = "only once: RViz misses it"
                yield _missed(each, policy, "info", known.name, follows)


def _volatile(
    around: Surroundings, node: RunningNode, whole: str, each: DisplayTopic
) -> Iterator[Problem]:
    """Report a display that misses messages from before its start."""
    policy = each.policies.get("Durability Policy")
    if policy is None or policy.value != "Volatile":
        return
    ends = around.running.endpoints(whole)
    kept = [(other, end) for other, end in ends if end.publishes and end.latched]
    beside = [pair for pair in kept if pair[0].launch == node.launch]
    for other, _ in (beside or kept)[:1]:
        once = all(end.latched == "once" for _, end in beside or kept)
        follows = "only once: RViz misses it" if once else "seldom: RViz waits for it"
        severity = "warning" if once else "info"
        yield _missed(each, policy, severity, other.path.strip("/"), follows)


def _missed(
    each: DisplayTopic, policy: Fact, severity: Severity, source: str, follows: str
) -> Problem:
    right = "Transient Local"
    return Problem.at(
        policy.place,
        severity,
        "display-volatile",
        f"the display {each.name} reads {each.topic.value} with the Durability Policy "
        f"Volatile, but {source} publishes it {follows}",
        write(
            policy.place, "Volatile", right, hint=f"write Durability Policy: {right}"
        ),
    )


def _of_tool(around: Surroundings, whole: str, each: DisplayTopic) -> Iterator[Problem]:
    """Report the topic of a tool that has the name of ROS 1, or is misspelt."""
    topics = known_nodes().tool_topics.get(each.kind.value, ())
    if not topics or any(
        not end.publishes for _, end in around.running.endpoints(whole)
    ):
        return
    right, *old = topics
    name, read = bare(whole), any(around.running.endpoints(f"/{right}"))
    if name in old:
        cause = "is the topic of ROS 1"
    elif name != right and is_misspelt(name, right) and not around.namespaced:
        cause = "is read by no node"
    else:
        return
    place = each.topic.place
    yield Problem.at(
        place,
        "warning" if read else "info",
        "topic-unknown",
        f"the tool {_short(each.kind.value)} publishes {each.topic.value}, which "
        f"{cause}: Nav2 reads /{right}",
        write(place, each.topic.value, f"/{right}"),
    )
