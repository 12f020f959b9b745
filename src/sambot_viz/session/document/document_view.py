"""Views of the document as `View`s, and the frame that one follows."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from sambot_viz.displays.picking.triangle_mesh import Corners
from sambot_viz.errors import UsageError
from sambot_viz.rviz import FIXED_FRAME, RvizConfig, ViewConfig
from sambot_viz.rviz.yaml.yaml_document import ConfigFindings
from sambot_viz.rviz.yaml.yaml_nodes import copied_map
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.camera import UP, Camera, Vector
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.view import WORLD, Target, View, rounded

USUAL_SIZE = (1280, 720)
"""Size of a page that no browser shows yet [pixels]."""


class DocumentView:
    """The document's view, which a client shows first.

    Args:
        picker: finds how large the robot is.
    """

    def __init__(self, document: ShownDocument, scene: Scene, picker: Picker) -> None:
        self._document = document
        self._scene = scene
        self._picker = picker

    @property
    def view(self) -> View:
        """A copy of the view."""
        return view_of(self._document.config.detached_view())

    @property
    def camera(self) -> Camera:
        """The camera of the view, in the fixed frame."""
        view = view_of(self._document.config.view)
        return view.camera(self._target(view))

    @property
    def target(self) -> Target:
        """Where the frame is that it follows."""
        return self._target(view_of(self._document.config.view))

    def camera_on_robot(self, width: int, height: int) -> Camera:
        """Return that camera, moved so that it shows the first sight of the scene.

        Args:
            width: width of the picture [pixels].
            height: height of the picture [pixels].
        """
        view = self.view
        target = self._target(view)
        box = first_box(self._document, self._scene, self._picker)
        if box is not None:
            for path, value in view.fit(*box, width, height, target).items():
                view.config.set(path, value)
        return view.camera(target)

    # Changing it, as a program does; clients take it with `Clients.show_view`.

    def look_at(self, point: Vector, position: Vector | None = None) -> None:
        """Look at a point of the fixed frame.

        Args:
            point: the point for the middle of the picture, (3,) [m].
            position: the place of the camera, (3,) [m]; by default the present one. A
                view that looks straight down becomes one that can look from there.
        """
        view = self.view
        if position is not None:
            if view.from_above:
                view = view_of(self._as_kind(OrbitView.kind))
            values = view.read(Camera(position, point, UP), self._target(view))
        else:
            if not view.gives_nearness:
                # From where a page begins, and not from RViz's 10 m.
                view = self._read(view, self.camera_on_robot(*USUAL_SIZE))
            values = view.look_at(point, self._target(view))
        self._store(view, rounded(values))

    def set_kind(self, kind: str) -> None:
        """Take another type of view, which takes over what the present one shows.

        Raises:
            UsageError: an unknown type.
        """
        require_kind(kind)
        if kind != self.view.kind:
            self._store(view_of(self._as_kind(kind)), {})

    def set(self, values: Mapping[str, object]) -> None:
        """Set some of its values, by their paths.

        Raises:
            UsageError: there is no such value, or it cannot be set to that.
        """
        self._store(self.view, values)

    def use(self, saved: ViewConfig) -> None:
        """Take a copy of a saved view."""
        self._store(view_of(self._document.config.detached_view(saved)), {})

    def follow(self, frame: str) -> None:
        """Follow a frame; the picture stays, except for a turn of the frame."""
        view = self.view
        before = self._target(view)
        given = view.gives_nearness
        view.config.set("Target Frame", frame)
        shift = before.position - self._target(view).position
        self._store(view, rounded(view.shifted(shift)), placed=given)

    def _target(self, view: View) -> Target:
        return target_of(self._scene, view)

    def _read(self, view: View, camera: Camera) -> View:
        for path, value in view.read(camera, self._target(view)).items():
            view.config.set(path, value)
        return view

    def _as_kind(self, kind: str) -> ViewConfig:
        return as_kind(self._document.config, self.view, kind, USUAL_SIZE[1])

    def _store(
        self, view: View, values: Mapping[str, object], *, placed: bool = True
    ) -> None:
        """Write a view into the document.

        Args:
            view: a view that is not in the document.
            values: what else it is to say.
            placed: whether it says how near the camera is, also where that is RViz's
                default; otherwise clients show the whole robot at first.
        """
        for path, value in values.items():
            view.config.set(path, value)
        config = self._document.config
        config.store_view(view.config)
        if placed:
            config.view.fill()


def first_box(document: ShownDocument, scene: Scene, picker: Picker) -> Corners | None:
    """Return the box around the first sight of the scene; None if nothing is drawn.

    It contains the robot and, where no config chooses among them, all data. A recording
    of frames alone counts with all its times.
    """
    if document.config.unasked:
        return picker.first_box()
    box = picker.robot_box()
    view = view_of(document.config.detached_view())
    follows = view.config.get("Target Frame") != FIXED_FRAME
    if box is None or follows or not document.config.fits_frames:
        return box
    run = scene.whole_run().box(scene.context.fixed_frame) or box
    return np.minimum(box[0], run[0]), np.maximum(box[1], run[1])


def require_kind(kind: str) -> None:
    """Raise UsageError for an unknown type of view."""
    if kind not in VIEWS:
        known = ", ".join(VIEWS)
        raise UsageError(f"there is no view type '{kind}'; there are {known}")


def as_kind(config: RvizConfig, old: View, kind: str, height: int) -> ViewConfig:
    """Return a view of another type that takes over what the old one showed.

    Args:
        config: the document; the view is not put into it.
        old: the view before.
        kind: the new type.
        height: of the picture [pixels].
    """
    new = config.new_view(kind, old.config)
    # As in RViz, all other values start at their defaults.
    for path, declared in new.declared.items():
        if path in new.properties and path != "Target Frame":
            new.set(path, declared.property.default)
    new.set("Target Frame", old.config.get("Target Frame"))
    view = view_of(new)
    for values in (view.mimic(old), rounded(view.as_near_as(old, height))):
        for path, value in values.items():
            new.set(path, value)
    return new


def view_of(config: ViewConfig) -> View:
    """Return the view of a config; one of an unknown type is shown as Orbit."""
    known = VIEWS.get(config.kind)
    if known is not None:
        return known(config)
    # Its own values stay as they are.
    copy = copied_map(config.node)
    return OrbitView(ViewConfig(copy, OrbitView.properties, ConfigFindings(None)))


def has_target(scene: Scene, view: View) -> bool:
    """Return whether a view follows another frame than the fixed one."""
    context = scene.context
    return context.frame(view.config.get("Target Frame")) != context.fixed_frame


def target_of(scene: Scene, view: View, last: Target = WORLD) -> Target:
    """Return the target frame of a view in the fixed frame.

    Args:
        scene: has the frames.
        view: whose target frame it is.
        last: the answer for a frame that cannot be placed.
    """
    if not has_target(scene, view):
        return WORLD
    fixed, tree = scene.context.fixed_frame, scene.context.tree
    name = scene.context.frame(view.config.get("Target Frame"))
    if not tree.can_lookup(fixed, name):
        return last
    T = tree.lookup(fixed, name).matrix
    return Target(T[:3, 3], math.atan2(T[1, 0], T[0, 0]))


def mouse_facts(view: View) -> dict[str, Any]:
    """Return what the page's own mouse handling has to know of a view."""
    config = view.config
    known = config.declared
    return {
        "kind": view.kind.rpartition("/")[2],
        "focalSize": (
            config.get("Focal Shape Size") if "Focal Shape Size" in known else 0.0
        ),
        "focalFixed": (
            "Focal Shape Fixed Size" in known and config.get("Focal Shape Fixed Size")
        ),
    }
