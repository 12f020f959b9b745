"""Poses of links, joints and frames in the model, each relative to another frame."""

from __future__ import annotations

import numpy as np

from sambot_viz.geometry import Matrix
from sambot_viz.matrices import inverse_matrix
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.fields import pose_of, text_in
from sambot_viz.robot.sdf.frame_cycles import report_cycles
from sambot_viz.robot.sdf.old_versions import Version
from sambot_viz.robot.sdf.scopes import Frame, Scope, canonical_link
from sambot_viz.robot.sdf.unknown_frames import unknown_frame
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.xml.element import Element


class FramePoses:
    """The place of each frame in a model.

    A frame without a place, because of wrong names or a ring, is at the model's origin:
    its problem has been reported, and ROS refuses the model.
    """

    def __init__(self, scope: Scope, version: Version, findings: ModelFindings) -> None:
        """Find the base of every frame, and report wrong names and cycles."""
        self.scope = scope
        self._version = version
        self._findings = findings
        self._known: dict[Frame, Matrix] = {scope.own: np.eye(4)}
        frames: list[Frame] = []
        for inner in scope.all():
            for frame in inner.frames.values():
                self._connect(frame, inner)
            frames += inner.frames.values()
        report_cycles(frames, findings)
        for inner in reversed(list(scope.all())):
            self._place_nested(inner)

    def T_model_frame(self, frame: Frame) -> Matrix:
        """Return the pose of a frame in the model (4, 4)."""
        path: list[Frame] = []
        here: Frame | None = frame
        while here is not None and here not in self._known:
            # Frames in a ring are at the model's origin.
            self._known[here] = np.eye(4)
            path.append(here)
            here = here.base
        last = np.eye(4) if here is None else self._known[here]
        for step in reversed(path):
            last = self._known[step] = last @ step.T_base_frame
        return last

    def between(self, frame: Frame, other: Frame) -> Matrix:
        """Return T_frame_other (4, 4)."""
        if frame is other:
            return np.eye(4)
        return inverse_matrix(self.T_model_frame(frame)) @ self.T_model_frame(other)

    def of(self, part: Element, link: Frame) -> Matrix:
        """Return T_model_part (4, 4) of a visual, collision … of a link."""
        base = self._base_of_pose(part, self.scope) or link
        return self.T_model_frame(base) @ pose_of(part, self._findings)

    def named(self, name: str, at: Element, attribute: str) -> Frame | None:
        """Return the frame that an attribute names; None, and a finding, for none."""
        return self._named(name, at, attribute, self.scope)

    def _connect(self, frame: Frame, scope: Scope) -> None:
        """Find the frame that the pose of a frame is relative to."""
        frame.T_base_frame = pose_of(frame.element, self._findings)
        frame.attached = self._attached(frame, scope)
        base = self._base_of_pose(frame.element, scope)
        # A frame relative to an unknown one has no other base, which could be a ring.
        usual = scope.own if self._names_base(frame.element) else frame.attached
        frame.base = base or usual or scope.own

    def _attached(self, frame: Frame, scope: Scope) -> Frame | None:
        """Return the default base of a pose without a named frame, if there is one."""
        if frame.kind == "joint":
            return scope.find(text_in(frame.element, "child"))
        name = trimmed(frame.element.get("attached_to") or "")
        if frame.kind != "frame" or not name:
            return None
        return self._named(name, frame.element, "attached_to", scope)

    def _names_base(self, owner: Element) -> bool:
        pose = owner.find("pose")
        return pose is not None and self._version.relative_to(pose) != ""

    def _base_of_pose(self, owner: Element, scope: Scope) -> Frame | None:
        """Return the frame that the <pose> of an element names, or None."""
        pose = owner.find("pose")
        name = self._version.relative_to(pose) if pose is not None else ""
        if pose is None or not name:
            return None
        attribute = "relative_to" if pose.get("relative_to") else "frame"
        return self._named(name, pose, attribute, scope)

    def _named(
        self, name: str, at: Element, attribute: str, scope: Scope
    ) -> Frame | None:
        found = scope.find(name)
        if found is not None and found.element is at.parent:
            # A link relative to its own name means the joint with that name.
            return scope.namesakes.get(name, found)
        if found is not None:
            return found
        root = canonical_link(self.scope) if scope is self.scope else None
        words = unknown_frame(name, at, attribute, scope, root)
        self._findings.reject(
            "sdf-frame-unknown",
            words.message,
            words.hint,
            at,
            attribute,
            cause=f"frame {name}",
        )
        return None

    def _place_nested(self, scope: Scope) -> None:
        """Move nested models that a frame inside them places."""
        for inner in scope.nested.values():
            name = trimmed(inner.model.get("placement_frame") or "")
            if not name:
                continue
            placed = self._named(name, inner.model, "placement_frame", inner)
            T_own_placed = np.eye(4)
            while placed is not None and placed is not inner.own:
                T_own_placed = placed.T_base_frame @ T_own_placed
                placed = placed.base
            inner.own.T_base_frame = inner.own.T_base_frame @ inverse_matrix(
                T_own_placed
            )
