"""Topics that robot_localization and Nav2 read, against what is published in ROS."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from sambot_viz.checks.around.bridges import entries
from sambot_viz.checks.around.files.gazebo import Fact, Plugin
from sambot_viz.checks.around.files.parameters import Parameter
from sambot_viz.checks.around.navigation import filters, is_open
from sambot_viz.checks.around.place import where
from sambot_viz.checks.around.running.bridge_entries import bare
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.edits import write
from sambot_viz.errors import Problem, nearest

_ODOMETRY, _IMU, _SCAN, _CLOUD = "Odometry", "Imu", "LaserScan", "PointCloud2"
_FILTERED = "odometry/filtered"
_CLASSIC: dict[str, tuple[str, str]] = {
    "libgazebo_ros_imu_sensor.so": (_IMU, "~/out"),
    "libgazebo_ros_ray_sensor.so": ("", "~/out"),
    "libgazebo_ros_diff_drive.so": (_ODOMETRY, "odom"),
}
"""Plugin of Gazebo Classic → the type that it publishes, and its own topic.

The type of a ray sensor is in its <output_type>.
"""

_USED: tuple[tuple[str, str, str], ...] = (
    ("bt_navigator", "odom_topic", _ODOMETRY),
    ("controller_server", "odom_topic", _ODOMETRY),
    ("velocity_smoother", "odom_topic", _ODOMETRY),
    ("amcl", "scan_topic", _SCAN),
    ("slam_toolbox", "scan_topic", _SCAN),
)


class Published(NamedTuple):
    """A topic in ROS: its name with its place, its type, and who publishes it."""

    topic: Fact
    kind: str
    what: str


class _Used(NamedTuple):
    """A topic that a node reads, and its type."""

    parameter: Parameter
    kind: str


def unknown_topics(around: Surroundings) -> Iterator[Problem]:
    """Report topics that are read under another name than they are published."""
    published = list(published_topics(around))
    if around.namespaced:
        return
    used = list(used_topics(around))
    renamed = {u.kind: p for p, u in _renamed(around, used, published)}
    yield from renamed.values()
    for parameter, kind in used:
        name = bare(parameter.fact.value)
        if any(bare(p.topic.value) == name for p in published):
            # It is there; whether its type is the right one is another question.
            continue
        known = {bare(p.topic.value): p for p in published if p.kind == kind}
        if not known or name in known or is_open(name) or name == _FILTERED:
            continue
        others = [u for u in used if _same(u.parameter, parameter)]
        if any(bare(u.parameter.fact.value) in known for u in others):
            # Another file fits this simulation; this one is for another robot.
            continue
        if around.said_elsewhere(name, as_topic=True) or _of_a_node(around, name):
            continue
        near = _meant(name, known) or _only(known, around)
        if near is not None and kind not in renamed:
            yield _unknown(parameter, kind, known[near])


def _unknown(parameter: Parameter, kind: str, source: Published) -> Problem:
    return Problem.at(
        parameter.place,
        "warning",
        "topic-unknown",
        f"{parameter.node} reads {parameter.fact.value}, but {source.what} "
        f"publishes this {kind} as {source.topic.value} "
        f"({where(source.topic.place, parameter.place)})",
        write(parameter.place, parameter.fact.value, source.topic.value),
    )


def _only(known: Mapping[str, Published], around: Surroundings) -> str | None:
    """The one topic of a type, when nobody else can publish another."""
    alone = len(known) == 1 and around.simulates_only_known
    return next(iter(known)) if alone else None


def _renamed(
    around: Surroundings, used: Sequence[_Used], published: Sequence[Published]
) -> Iterator[tuple[Problem, _Used]]:
    """Entries of a bridge whose topic all read under its name in Gazebo."""
    names = {bare(p.topic.value) for p in published}
    for entry in entries(around):
        gz, ros = bare(entry.gz.value), entry.ros
        kind = entry.ros_type.value.rpartition("/")[2]
        readers = [u for u in used if u.kind == kind]
        agree = all(bare(u.parameter.fact.value) == gz for u in readers)
        if len(readers) < 2 or not agree or gz in names or gz == bare(ros.value):
            continue
        elsewhere = around.said_elsewhere(gz, as_topic=True, launched=True)
        if elsewhere or not entry.reaches_ros:
            continue
        first = readers[0].parameter
        problem = Problem.at(
            ros.place,
            "warning",
            "topic-unknown",
            f"the bridge publishes this {kind} as {ros.value}, but {first.node} "
            f"({where(first.place, ros.place)}) and all others read "
            f"{first.fact.value}",
            write(ros.place, ros.value, f"/{gz}"),
        )
        yield problem, readers[0]


def kinds_read(around: Surroundings) -> dict[str, Fact]:
    """Return the topics that nodes read, each with its type and the line of it."""
    return {
        bare(parameter.fact.value): Fact(kind, parameter.place)
        for parameter, kind in used_topics(around)
    }


def _of_a_node(around: Surroundings, topic: str) -> bool:
    """True for a topic below the name of a node or controller of the package."""
    owner = topic.rpartition("/")[0]
    nodes = {
        part for file in around.yaml_files for n in file.nodes for part in n.split("/")
    }
    return bool(owner) and (owner in nodes or around.said_elsewhere(owner))


def _same(one: Parameter, other: Parameter) -> bool:
    """The same setting of the same node in another file."""
    return (one.node, one.name) == (other.node, other.name) and one is not other


def _meant(name: str, known: dict[str, Published]) -> str | None:
    """The topic that is meant: the same below another name, or a similar one."""
    last = name.rpartition("/")[2]
    same = [k for k in known if k.rpartition("/")[2] == last]
    return same[0] if same else nearest(name, known)


def used_topics(around: Surroundings) -> Iterator[_Used]:
    """Give the topics that nodes read, each with its type."""
    for one in filters(around):
        if one.started:
            for kind, message in (("odom", _ODOMETRY), ("imu", _IMU)):
                for parameter in one.inputs(kind):
                    yield _Used(parameter, message)
    kinds = {
        (p.node, p.name.removesuffix(".data_type")): p.fact.value
        for p in around.parameters
        if p.name.endswith(".data_type")
    }
    for parameter in around.parameters:
        for node, name, kind in _USED:
            if parameter.name == name and node in parameter.node.split("/"):
                yield _Used(parameter, kind)
        if parameter.name.endswith(".topic"):
            source = (parameter.node, parameter.name.removesuffix(".topic"))
            if kinds.get(source) in (_SCAN, _CLOUD):
                yield _Used(parameter, kinds[source])


def published_topics(around: Surroundings) -> Iterator[Published]:
    """Give the topics in ROS that bridges and plugins publish."""
    for entry in entries(around):
        if entry.reaches_ros:
            kind = entry.ros_type.value.rpartition("/")[2]
            yield Published(entry.ros, kind, "the bridge")
    for plugin in around.plugins:
        yield from _of_classic(plugin)


def _of_classic(plugin: Plugin) -> Iterator[Published]:
    kind, topic = _CLASSIC.get(plugin.filename, ("", ""))
    output = plugin.one("output_type")
    if output is not None:
        kind = output.value.rpartition("/")[2]
    if not kind or not topic:
        return
    ros = plugin.element.find("ros")
    place, namespace = plugin.element.place, ""
    for child in ros.children if ros is not None else ():
        text = child.text.strip()
        old, becomes, new = text.partition(":=")
        if child.tag == "remap":
            old, becomes, new = child.get("from") or "", ":=", child.get("to") or ""
        if child.tag == "namespace":
            namespace, place = bare(text), child.place
        elif becomes and old in (topic, topic.removeprefix("~/")):
            topic, place = new, child.place
    name = plugin.element.get("name") or ""
    topic = topic.replace("~", name)
    whole = topic if topic.startswith("/") or not namespace else f"{namespace}/{topic}"
    if not is_open(whole):
        fact = Fact(f"/{bare(whole)}", place)
        yield Published(fact, kind, f"the plugin {plugin.filename}")
