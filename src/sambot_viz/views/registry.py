"""All views this program knows: a new one is a new file and a line here."""

from __future__ import annotations

from sambot_viz.views.orbit import OrbitView
from sambot_viz.views.view import View

VIEWS: dict[str, type[View]] = {view.kind: view for view in (OrbitView,)}
