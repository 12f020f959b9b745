"""Views of a config of their own, without a page."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from default_config import DEFAULT_TEXT

from sambot_viz.rviz import Declarations, RvizConfig
from sambot_viz.views.registry import VIEWS
from sambot_viz.views.view import View

MakeView = Callable[..., View]


@pytest.fixture
def make_view() -> MakeView:
    """Make a view of a type: ``make_view("Orbit", Yaw=0.0, Focal_Point=(1, 2, 3))``."""
    declarations = Declarations(
        views={kind: view.properties for kind, view in VIEWS.items()}
    )

    def make(name: str, **values: Any) -> View:
        kind = f"rviz_default_plugins/{name}"
        config = RvizConfig.parse(DEFAULT_TEXT, declarations)
        view = VIEWS[kind](config.new_view(kind, config.view))
        for path, declared in view.config.declared.items():
            if path in view.config.properties:
                view.config.set(path, declared.property.default)
        for path, value in values.items():
            view.config.set(path.replace("_", " "), value)
        return view

    return make
