"""Conditions about what the files start: topics, bridges, parameters, transforms."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.checks.around.running.bridge_entries import BridgeEntry, bare
from sambot_viz.checks.around.running.system import RunningNode
from sambot_viz.checks.rule import listed, number
from sambot_viz.errors import UsageError, nearest
from sambot_viz.geometry import Vector3
from sambot_viz.lessons.conditions.condition import LENGTH, Unmet, far, vector
from sambot_viz.lessons.conditions.gazebo import compared, same
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import FLAG, NUMBER, TEXT, TEXTS, VECTOR
from sambot_viz.lessons.work import Work


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeCondition:
    """A launch file starts a node of one of these packages."""

    package: tuple[str, ...] = given(TEXTS)
    executable: tuple[str, ...] = given(TEXTS, ())

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for it among the nodes that start."""
        started = [
            node
            for node in work.around.running.started
            if node.starts != "no" and node.place.file in work.launches
        ]
        for node in started:
            fits = not self.executable or node.executable in self.executable
            if node.package in self.package and fits:
                return
        names = [f"{node.package}/{node.executable}" for node in started]
        packages = " or ".join(self.package)
        which = " or ".join(self.executable)
        expected = f"{packages}/{which}" if which else f"a node of {packages}"
        yield Unmet(f"the launch files start {listed(names) or 'nothing'}", expected)


@dataclass(frozen=True, slots=True, kw_only=True)
class TopicCondition:
    """A topic is published, or read, by what the files start."""

    name: tuple[str, ...] = given(TEXTS)
    type: str = given(TEXT, "")
    published: bool | None = given(FLAG, None)
    read: bool | None = given(FLAG, None)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Ask the model of what runs."""
        running = work.around.running
        wanted = {f"/{bare(name)}" for name in self.name}
        ends = [
            end
            for node in running.started
            for end in node.endpoints
            if not end.in_gazebo
        ]
        name = " or ".join(sorted(wanted))
        for verb, publishes, needed in (
            ("publishes", True, self.published),
            ("reads", False, self.read),
        ):
            of_it = [e for e in ends if e.publishes == publishes]
            found = [e for e in of_it if e.topic in wanted]
            if needed and not found:
                near = nearest(sorted(wanted)[0], [e.topic for e in of_it])
                like = f", but {near}" if near else ""
                yield Unmet(f"nothing {verb} {name}{like}", f"something {verb} it")
            for end in found:
                if self.type and end.kind and end.kind != self.type:
                    yield Unmet(
                        f"the type of {end.topic} is {end.kind}", self.type, end.place
                    )


@dataclass(frozen=True, slots=True, kw_only=True)
class BridgeCondition:
    """A bridge carries a topic between Gazebo and ROS."""

    ros: tuple[str, ...] = given(TEXTS)
    type: tuple[str, ...] = given(TEXTS)
    direction: tuple[str, ...] = given(TEXTS)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look for the entry."""
        entries = work.around.bridged
        fitting = [e for e in entries if any(same(e.ros.value, x) for x in self.ros)]
        name = " or ".join(self.ros)
        if not fitting:
            topics = [entry.ros.value for entry in entries]
            found = f"only {listed(topics)}" if topics else "nothing"
            yield Unmet(f"the bridge carries {found}", name)
        for entry in fitting[:1]:
            yield from self._faults(entry)

    def _faults(self, entry: BridgeEntry) -> Iterator[Unmet]:
        what = f"of {entry.ros.value} in the bridge"
        kind, way = entry.ros_type, entry.direction
        yield from compared(f"the type {what}", kind.value, self.type, kind.place)
        # A bridge in both directions does what is needed too.
        ways = (*self.direction, "BIDIRECTIONAL")
        if way.value not in ways:
            expected = " or ".join(self.direction)
            yield Unmet(f"the direction {what} is {way.value}", expected, way.place)


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterCondition:
    """A node has a parameter in a YAML file, of some value or range."""

    node: str = given(TEXT)
    name: str = given(TEXT)
    value: tuple[str, ...] = given(TEXTS, ())
    has: tuple[str, ...] = given(TEXTS, ())
    least: float | None = given(NUMBER, None)
    most: float | None = given(NUMBER, None)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Compare its value."""
        own = [p for p in work.around.parameters if p.node.strip("/") == self.node]
        said = next((p for p in own if p.name == self.name), None)
        if said is None:
            near = nearest(self.name, [p.name for p in own])
            like = f", but there is {near}" if near else ""
            what = f"the parameter {self.name} of {self.node} is not given{like}"
            yield Unmet(what, "a line with it in a YAML file")
            return
        what = f"{self.name} of {self.node}"
        if self.value:
            text = ", ".join(said.values)
            yield from compared(what, text, self.value, said.place)
        for word in self.has:
            if not any(same(word, one) for one in said.values):
                found = f"{what} is {listed(said.values) or 'empty'}"
                yield Unmet(found, f"{word} in it", said.place)
        if self.least is not None or self.most is not None:
            value = said.fact.number
            low, high = self.least, self.most
            if value is None or not (low or value) <= value <= (high or value):
                ends = [
                    f"{word} {number(end)}"
                    for word, end in (("at least", low), ("at most", high))
                    if end is not None
                ]
                found = f"{what} is {said.fact.value}"
                yield Unmet(found, " and ".join(ends), said.place)


@dataclass(frozen=True, slots=True, kw_only=True)
class StaticTransformCondition:
    """A launch file starts a static_transform_publisher with a pose."""

    parent: str = given(TEXT, key="from")
    child: str = given(TEXT, key="to")
    xyz: Vector3 = given(VECTOR)
    tolerance: float = given(NUMBER, LENGTH)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Read the arguments of each such node."""
        nodes = [
            node
            for node in work.around.running.started
            if node.executable == "static_transform_publisher"
        ]
        if not nodes:
            expected = f"one from {self.parent} to {self.child}"
            yield Unmet("no launch file starts a static_transform_publisher", expected)
            return
        faults = [list(self._faults(node)) for node in nodes]
        yield from min(faults, key=len)

    def _faults(self, node: RunningNode) -> Iterator[Unmet]:
        # The import is late: only transforms need numpy.
        from sambot_viz.frames.static_transform import parse_static_transform

        words = [word or "" for word in node.arguments]
        try:
            said = parse_static_transform(words)
        except UsageError as error:
            expected = "numbers and frames that it takes"
            yield Unmet(str(error).partition("; ")[0], expected, node.place)
            return
        if (said.parent, said.child) != (self.parent, self.child):
            found = f"the transform is from {said.parent} to {said.child}"
            expected = f"from {self.parent} to {self.child}"
            yield Unmet(found, expected, node.place)
            return
        x, y, z = (float(value) for value in said.transform.matrix[:3, 3])
        if far((x, y, z), self.xyz) > self.tolerance:
            found = f"{self.child} is at {vector((x, y, z))} in {self.parent}"
            yield Unmet(found, f"at {vector(self.xyz)}", node.place)
        for warning in said.warnings:
            yield Unmet(warning.partition(": write")[0], "radians", node.place)
