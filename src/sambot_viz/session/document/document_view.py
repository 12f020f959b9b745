"""Views of the document as `View`s, and the frame that one follows."""

from __future__ import annotations

import math
from typing import Any

from sambot_viz.rviz import FIXED_FRAME, ViewConfig
from sambot_viz.rviz.yaml.document import ConfigFindings
from sambot_viz.rviz.yaml.nodes import copied_map
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.scene.picker import Picker
from sambot_viz.session.scene.scene import Scene
from sambot_viz.views.camera import Camera
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.view import WORLD, Target, View


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
        return view.camera(target_of(self._scene, view))

    def camera_on_robot(self, width: int, height: int) -> Camera:
        """Return that camera, moved to where it shows the whole robot.

        Args:
            width: of the picture [pixels].
            height: of the picture [pixels].
        """
        view = self.view
        target, box = target_of(self._scene, view), self._picker.robot_box()
        if box is not None:
            for path, value in view.fit(*box, width, height, target).items():
                view.config.set(path, value)
        return view.camera(target)


def view_of(config: ViewConfig) -> View:
    """Return the view of a config; one of an unknown type is shown as Orbit."""
    known = VIEWS.get(config.kind)
    if known is not None:
        return known(config)
    # Its own values stay as they are.
    copy = copied_map(config.node)
    return OrbitView(ViewConfig(copy, OrbitView.properties, ConfigFindings(None)))


def has_target(scene: Scene, view: View) -> bool:
    """Tell whether a view follows another frame than the fixed one."""
    name = view.config.get("Target Frame")
    return name not in (FIXED_FRAME, scene.context.fixed_frame)


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
    name = str(view.config.get("Target Frame"))
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
