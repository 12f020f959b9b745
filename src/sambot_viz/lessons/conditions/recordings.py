"""Conditions about a recording of the robot that ran, in the student's folder."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from sambot_viz.checks.rule import listed, number
from sambot_viz.errors import nearest
from sambot_viz.lessons.conditions.condition import Unmet
from sambot_viz.lessons.reading.records import given
from sambot_viz.lessons.reading.values import NUMBER, TEXT, TEXTS
from sambot_viz.lessons.work import Work


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedCondition:
    """A recording in the folder has a topic, so many times a second [Hz]."""

    topic: tuple[str, ...] = given(TEXTS)
    type: str = given(TEXT, "")
    rate: float = given(NUMBER, 0.0)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Count the messages."""
        topics = work.recording.seen.topics
        name = next((one for one in self.topic if one in topics), None)
        if name is None:
            wanted = " or ".join(self.topic)
            near = nearest(self.topic[0], topics)
            like = f", but {near}" if near else ""
            yield Unmet(f"the recording has no {wanted}{like}", "messages of it")
            return
        seen = topics[name]
        if self.type and seen.type_name.replace("/msg/", "/") != self.type.replace(
            "/msg/", "/"
        ):
            yield Unmet(f"the type of {name} is {seen.type_name}", self.type)
        if seen.rate < self.rate:
            found = f"{name} comes {number(seen.rate)} times a second"
            yield Unmet(found, f"at least {number(self.rate)} times")


@dataclass(frozen=True, slots=True, kw_only=True)
class MovedCondition:
    """In a recording a frame is known in another one, and moves so far [m]."""

    parent: str = given(TEXT, key="from")
    child: str = given(TEXT, key="to")
    distance: float = given(NUMBER, 0.0)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Follow the frame from where it was first."""
        first, most = None, 0.0
        for position in work.recording.path_of(self.parent, self.child):
            first = first or position
            most = max(most, math.dist(first, position))
        if first is None:
            known = listed(sorted(work.recording.seen.parents)) or "none"
            what = f"the recording has no transform from {self.parent} to {self.child}"
            yield Unmet(f"{what}; frames with a parent: {known}", "one")
        elif most < self.distance:
            found = f"{self.child} is at most {number(most)} m from where it begins"
            yield Unmet(found, f"{number(self.distance)} m")


@dataclass(frozen=True, slots=True, kw_only=True)
class GoalCondition:
    """In a recording a goal of an action was reached, such as navigate_to_pose."""

    action: tuple[str, ...] = given(TEXTS)

    def unmet(self, work: Work) -> Iterator[Unmet]:
        """Look at the statuses of its goals."""
        reached = work.recording.seen.goals
        if reached.isdisjoint(self.action):
            wanted = " or ".join(self.action)
            found = listed(sorted(reached)) or "none"
            yield Unmet(
                f"of these actions a goal was reached: {found}",
                f"a goal of {wanted} with the status SUCCEEDED",
            )
