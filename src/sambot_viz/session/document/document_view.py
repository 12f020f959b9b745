"""A view of the document as a `View`, and the frame that it follows."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from sambot_viz.rviz import FIXED_FRAME, ViewConfig
from sambot_viz.rviz.yaml.document import ConfigFindings
from sambot_viz.rviz.yaml.nodes import copied_map
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.view import WORLD, Target, View

if TYPE_CHECKING:
    from sambot_viz.session.document.shown_document import ShownDocument


def view_of(config: ViewConfig) -> View:
    """The view of a config; one of an unknown type is shown as Orbit."""
    known = VIEWS.get(config.kind)
    if known is not None:
        return known(config)
    # Its own values stay as they are.
    copy = copied_map(config.node)
    return OrbitView(ViewConfig(copy, OrbitView.properties, ConfigFindings(None)))


def target_of(session: ShownDocument, view: View, last: Target = WORLD) -> Target:
    """The target frame of a view in the fixed frame.

    Args:
        session: has the frames.
        view: whose target frame it is.
        last: the answer for a frame that cannot be placed.
    """
    fixed, name = session.context.fixed_frame, view.config.get("Target Frame")
    if name in (FIXED_FRAME, fixed):
        return WORLD
    if not session.tree.can_lookup(fixed, str(name)):
        return last
    T = session.tree.lookup(fixed, str(name)).matrix
    return Target(T[:3, 3], math.atan2(T[1, 0], T[0, 0]))


def mouse_facts(view: View) -> dict[str, Any]:
    """What the page's own mouse handling has to know of a view."""
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
