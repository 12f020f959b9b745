"""Report topics whose two ends do not meet: at a controller, a relay, a node itself."""

from __future__ import annotations

from collections.abc import Iterator

from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.running.system import Endpoint, RunningNode
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.around.topics.read import is_placed, published_topics
from sambot_viz.edits import exchange, write
from sambot_viz.errors import Place, Problem


def topics_of_oneself(around: Surroundings) -> Iterator[Problem]:
    """Report a node that reads the topic on which it publishes."""
    done: set[Place] = set()
    for node in around.running.started:
        if node.is_bridge or not is_placed(around, node):
            continue
        sent = {e.topic: e for e in node.endpoints if e.publishes and e.kind}
        for end in node.endpoints:
            other = sent.get(end.topic)
            if end.publishes or not end.parameter or other is None:
                # Without a parameter, an unknown remapping may separate the two.
                continue
            if other.message != end.message:
                continue
            if end.place not in done:
                done.add(end.place)
                yield _of_itself(around, node, end, other)


def _of_itself(
    around: Surroundings, node: RunningNode, end: Endpoint, own: Endpoint
) -> Problem:
    read = {each.topic for each in node.endpoints if not _out(each)}
    free = [
        source.topic.value
        for source in published_topics(around)
        if source.kind == end.message and source.what != node.path.strip("/")
        if source.topic.value not in read
    ]
    what = node.path.strip("/")
    renamed = "" if bare(own.written) == bare(own.topic) else f", for {own.written}"
    return Problem.at(
        end.place,
        "warning",
        "topic-unknown",
        f"{what} reads {end.written or end.topic}, and publishes its own "
        f"{end.message} there{renamed}: it gets what it sends",
        write(end.place, end.written, free[0])
        if len(set(free)) == 1
        else f"write another topic for {end.parameter}",
    )


def _out(end: Endpoint) -> bool:
    return end.publishes or end.in_gazebo


def unheard_commands(around: Surroundings) -> Iterator[Problem]:
    """Report a publisher whose topic is below a controller that has another one."""
    running = around.running.started
    heard = {e.topic for n in running for e in n.endpoints if not _out(e)}
    paths = {node.path for node in running}
    done: set[Place] = set()
    for node in running:
        for end in node.endpoints if node.starts == "yes" else ():
            owner, _, last = end.topic.rpartition("/")
            if not end.publishes or end.in_gazebo or end.topic in heard or not owner:
                continue
            if owner == node.path or not end.kind:
                continue
            beside = [n for n in running if n.launch == node.launch]
            meant = {
                e.topic: (n, e)
                for n in beside
                for e in n.endpoints
                if n.starts == "yes" and e.topic.startswith(f"{n.path}/")
                if not _out(e) and e.message == end.message
                if n.path == owner or (owner not in paths and _ends(e, last))
            }
            known = owner in paths or all(n.endpoints_known for n in beside)
            if len(meant) != 1 or not known:
                continue
            place = remapped_at(around, node)
            if place not in done:
                done.add(place)
                ((reader, read),) = meant.values()
                yield Problem.at(
                    place,
                    "warning",
                    "topic-unknown",
                    f"{node.path.strip('/')} publishes {end.topic}, which nothing "
                    f"reads: {reader.name} ({where(reader.place, place)}) reads this "
                    f"{read.message} from {read.topic}",
                    write(place, end.topic, read.topic),
                )


def _ends(end: Endpoint, last: str) -> bool:
    return end.topic.rpartition("/")[2] == last


def remapped_at(around: Surroundings, node: RunningNode) -> Place:
    """Return the place of the remappings of a node, or its own."""
    for launch in around.launches:
        for call in launch.called():
            given = call.given("remappings")
            if call.place == node.place and given is not None:
                return launch.place(given)
    return node.place


def exchanged_relays(around: Surroundings) -> Iterator[Problem]:
    """Report a relay from a topic of nobody to one that has a publisher."""
    running = around.running.started
    for node in running:
        read = [e for e in node.endpoints if not e.publishes and not e.kind]
        sent = [e for e in node.endpoints if e.publishes and not e.kind]
        if len(read) != 1 or len(sent) != 1 or len(node.argument_places) < 2:
            continue
        (one,), (two,) = read, sent
        others = {
            e.topic: e
            for n in running
            for e in n.endpoints
            if n is not node and e.publishes and not e.in_gazebo
        }
        source = others.get(two.topic)
        if source is None or one.topic in others:
            continue
        first, second = node.argument_places[:2]
        yield Problem.at(
            first,
            "warning",
            "topic-unknown",
            f"{node.path.strip('/')} reads {one.written}, which nothing publishes, and "
            f"publishes {two.written}, as another node does already "
            f"({where(source.place, first)}): the two are exchanged",
            exchange(
                f"write {two.written}, {one.written}",
                (first, one.written),
                (second, two.written),
            ),
        )
