"""All views this program knows: a new one is a new file and a line here."""

from __future__ import annotations

from sambot_viz.views.fps import FPSView
from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.top_down_ortho import TopDownOrthoView
from sambot_viz.views.view import View
from sambot_viz.views.xy_orbit import ThirdPersonFollowerView, XYOrbitView

VIEWS: dict[str, type[View]] = {
    view.kind: view
    for view in (
        OrbitView,
        XYOrbitView,
        ThirdPersonFollowerView,
        TopDownOrthoView,
        FPSView,
    )
}
