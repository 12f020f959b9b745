"""The names of a model: links, joints, frames and nested models, each once.

A nested model has a separate scope; from outside, its names are ``model::name``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from sambot_viz import limits
from sambot_viz.errors import Place
from sambot_viz.geometry import Matrix
from sambot_viz.robot.findings import ModelFindings
from sambot_viz.robot.sdf.fields import text_in
from sambot_viz.robot.sdf.old_versions import Version
from sambot_viz.robot.sdf.repeated_names import report_repeated
from sambot_viz.robot.sdf.values import trimmed
from sambot_viz.robot.sdf.wording import REFUSED
from sambot_viz.robot.xml.element import Element

OWN = "__model__"
"""The name of a model's own frame."""

_KINDS = ("link", "joint", "frame")


@dataclass(slots=True, eq=False)
class Frame:
    """A name that poses can be relative to.

    Attributes:
        name: its name in the model.
        kind: "model", "link", "joint" or "frame".
        element: its element.
        base: the frame that its pose is relative to; None for the whole robot, and
            while it is not known.
        attached: the frame that a <frame> moves with, or the child of a joint.
        T_base_frame: its pose in the base (4, 4).
    """

    name: str
    kind: str
    element: Element
    base: Frame | None = None
    attached: Frame | None = None
    T_base_frame: Matrix = field(default_factory=lambda: np.eye(4))


@dataclass(slots=True, eq=False)
class Scope:
    """The names inside one model.

    Attributes:
        own: the frame of the model itself.
        frames: name → frame, in the order libsdformat reads them.
        nested: name → names inside that nested model.
        namesakes: name of a link → a joint or frame with the same name.
    """

    own: Frame
    frames: dict[str, Frame] = field(default_factory=dict[str, Frame])
    nested: dict[str, Scope] = field(default_factory=dict[str, "Scope"])
    namesakes: dict[str, Frame] = field(default_factory=dict[str, Frame])

    @property
    def model(self) -> Element:
        """The <model>."""
        return self.own.element

    def find(self, name: str) -> Frame | None:
        """Return the frame of a name such as "arm", "gripper::palm" or "__model__"."""
        if name == OWN:
            return self.own
        if name in self.frames:
            return self.frames[name]
        scope = self
        *models, last = name.split("::")
        for model in models:
            if model not in scope.nested:
                return None
            scope = scope.nested[model]
        return scope.own if last == OWN else scope.frames.get(last)

    def without_own(self, name: str) -> str | None:
        """Return the rest of "model::arm" in that model itself; None for other names.

        A model does not find its own name in itself.
        """
        model, colons, rest = name.partition("::")
        own = trimmed(self.model.get("name") or "")
        is_own = bool(colons) and model == own and self.find(name) is None
        return rest if is_own and self.find(rest) is not None else None

    def of_kind(self, kind: str) -> list[Frame]:
        """Return the frames of one kind, in document order."""
        return [frame for frame in self.frames.values() if frame.kind == kind]

    def all(self) -> Iterator[Scope]:
        """Yield this scope and all in it."""
        stack: list[Scope] = [self]
        while stack:
            scope = stack.pop()
            yield scope
            stack.extend(reversed(scope.nested.values()))


def canonical_link(scope: Scope) -> Frame | None:
    """Return the link that the model names as its root, or the first; None for none."""
    links = scope.of_kind("link")
    name = trimmed(scope.model.get("canonical_link") or "")
    if not name:
        return links[0] if links else None
    frame = scope.frames.get(name)
    return frame if frame is not None and frame.kind == "link" else None


def read_scopes(
    model: Element, written: Element, version: Version, findings: ModelFindings
) -> Scope:
    """Read all names of a model, and report those that are not allowed.

    Args:
        model: the <model>, after xacro.
        written: root of the document before xacro, with the macro calls.
        version: version of the file.
        findings: receives the problems.
    """
    reader = _NameReader(written, version, findings)
    reader.check_name(model)
    top = Scope(Frame(OWN, "model", model))
    stack = [(top, 0)]
    while stack:
        scope, depth = stack.pop()
        reader.read(scope)
        if scope is not top:
            reader.check_nested(scope)
        if depth < limits.NESTED_MODELS.value:
            stack.extend((inner, depth + 1) for inner in scope.nested.values())
        elif scope.nested:
            reader.leave_out(scope)
    return top


class _NameReader:
    def __init__(
        self, written: Element, version: Version, findings: ModelFindings
    ) -> None:
        self._written = written
        self._version = version
        self._findings = findings
        self._repeating: set[Place] = set()

    def read(self, scope: Scope) -> None:
        for element in scope.model.find_all("model"):
            frame = self._take(scope, element, "model")
            if frame is not None:
                scope.nested[frame.name] = Scope(frame)
                of_world = text_in(element, "static").lower() in ("true", "1")
                self._findings.warn(
                    "sdf-nested-model",
                    f"ROS does not show the links of the nested model {frame.name}; "
                    "its frames count",
                    "delete it: what is static belongs to the world"
                    if of_world
                    else "write its links and joints into the model around it",
                    element,
                )
        for element in scope.model.children:
            if element.tag in _KINDS:
                self._take(scope, element, element.tag)
            if element.tag in ("link", "joint"):
                self._check_inside(element)

    def check_nested(self, scope: Scope) -> None:
        """Report a nested model without any link for its frame to move with."""
        static = text_in(scope.model, "static").lower() in ("true", "1")
        if not static and not scope.nested and not scope.of_kind("link"):
            self._findings.reject(
                "sdf-nested-model",
                f"the nested model {scope.model.get('name')} has no links; {REFUSED}",
                "delete it: ROS shows nothing of nested models",
                scope.model,
            )

    def leave_out(self, scope: Scope) -> None:
        """Report a model whose inner models are nested too deep to read."""
        self._findings.warn(
            "sdf-nested-model",
            f"what is in the models inside {scope.model.get('name')} is not read: "
            f"it is nested more than {limits.NESTED_MODELS.value} levels deep",
            "write its links and joints into the outermost model",
            scope.model,
        )

    def _take(self, scope: Scope, element: Element, kind: str) -> Frame | None:
        """Add the name of an element to a scope; None when the name is unusable."""
        name = self.check_name(element)
        if not name:
            return None
        other = scope.frames.get(name)
        if other is not None and other.kind == kind:
            self._report_repeated(name, element, other.element)
            return None
        frame = Frame(name, kind, element)
        if other is not None and not self._version.may_rename:
            self._set_apart(scope, frame, other)
            return frame
        if other is not None:
            name = frame.name = self._renamed(scope, element, name)
        scope.frames[name] = frame
        return frame

    def _set_apart(self, scope: Scope, frame: Frame, other: Frame) -> None:
        """Report two kinds with one name; continue as if one had another name."""
        name = other.name
        kept, renamed = (frame, other) if frame.kind == "link" else (other, frame)
        self._report_repeated(name, renamed.element, kept.element)
        renamed.name = _free_name(scope, renamed.element, name)
        scope.frames[name] = kept
        scope.frames[renamed.name] = renamed
        if kept.kind == "link":
            scope.namesakes.setdefault(name, renamed)

    def _renamed(self, scope: Scope, element: Element, name: str) -> str:
        new = _free_name(scope, element, name)
        self._findings.warn(
            "sdf-name-changed",
            f"the {element.tag} {name} has the name of a "
            f"{scope.frames[name].kind}; in a file of this version ROS calls it {new}",
            f'write name="{new}", or another name that is used once',
            element,
            "name",
        )
        return new

    def check_name(self, element: Element) -> str:
        """Return the name of an element, "" when it has none; report a reserved one."""
        name = trimmed(element.get("name") or "")
        reserved = len(name) > 3 and name[:2] == name[-2:] == "__"
        if reserved or name == "world":
            self._findings.reject(
                "sdf-name-reserved",
                f"the name {name} of this <{element.tag}> is reserved in SDF; "
                f"{REFUSED}",
                "write another name",
                element,
                "name",
            )
        elif "::" in name and not self._version.may_have_colons:
            self._findings.reject(
                "sdf-name-reserved",
                f"the name {name} of this <{element.tag}> has ::, which separates the "
                f"names of nested models; {REFUSED}",
                f"write {name.replace('::', '_')}",
                element,
                "name",
            )
        return name

    def _check_inside(self, part: Element) -> None:
        """Check the names of visuals, collisions, sensors … of one link or joint."""
        seen: dict[tuple[str, str], Element] = {}
        for element in part.children:
            if element.tag not in _INSIDE:
                continue
            name = self.check_name(element)
            first = seen.setdefault((element.tag, name), element)
            if name and first is not element:
                self._report_repeated(name, element, first)

    def _report_repeated(self, name: str, element: Element, first: Element) -> None:
        """Report a repeated name; of a macro call, only its first name."""
        if element.call is not None and element.call != first.call:
            if element.call in self._repeating:
                return
            self._repeating.add(element.call)
        report_repeated(name, element, first, self._written, self._findings)


def _free_name(scope: Scope, element: Element, name: str) -> str:
    """Return the name with libsdformat's ending for repeated names."""
    ending = f"{name}_{element.tag}"
    numbered = (f"{ending}{n}" for n in range(len(scope.frames) + 1))
    return next(n for n in (ending, *numbered) if n not in scope.frames)


_INSIDE = frozenset("visual collision sensor light particle_emitter projector".split())
