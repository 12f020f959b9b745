"""The tools of a session: what clicks do to a robot, without a page."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import yaml

from sambot_viz import Visualizer, bundled
from sambot_viz.session import Session
from sambot_viz.tools.measure import MeasureTool
from sambot_viz.tools.tool import Ray, Rays, Thing

PREFIX = "rviz_default_plugins/"


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    """sam_bot without the axes of its frames, which stand in front of its links."""
    config = yaml.safe_load(bundled.config_path().read_text("utf-8"))
    manager = config["Visualization Manager"]
    manager["Displays"] = [
        d for d in manager["Displays"] if not d["Class"].endswith("/TF")
    ]
    manager["Global Options"]["Fixed Frame"] = "base_link"
    manager["Tools"] = [
        {"Class": f"{PREFIX}MoveCamera"},
        {"Class": f"{PREFIX}Select"},
        {"Class": f"{PREFIX}Measure", "Line color": "1; 2; 3"},
    ]
    path = tmp_path / "tools.rviz"
    path.write_text(yaml.safe_dump(config), "utf-8")
    with Visualizer(config=path, port=0) as viz:
        shared = viz._server.shared  # pyright: ignore[reportPrivateUsage]
        assert shared is not None
        yield shared


def down(x: float, y: float, modifier: str | None = None) -> Ray:
    """A click from straight above."""
    return Ray(0, (x, y, 5.0), (0.0, 0.0, -1.0), modifier)


def choose(session: Session, name: str) -> None:
    session.tools.choose(PREFIX + name)


def selected(session: Session) -> set[str]:
    return {thing.name for thing in session.tools.selection}


def test_the_first_tool_of_the_file_is_current(session: Session) -> None:
    assert session.tools.current.label == "Move Camera"
    assert len(session.tools.tools) == 5


def test_a_click_selects_adds_and_removes(session: Session) -> None:
    choose(session, "Select")
    tool = session.tools.current
    tool.click(down(0.0, 0.0))
    assert list(session.tools.selection) == [Thing("link", "base_link")]
    tool.click(down(-0.12, 0.18, "shift"))
    assert selected(session) == {"base_link", "drivewhl_l_link"}
    tool.click(down(0.0, 0.0, "shift"))
    assert len(session.tools.selection) == 2
    tool.click(down(0.0, 0.0, "cmd/ctrl"))
    assert selected(session) == {"drivewhl_l_link"}
    tool.click(down(3.0, 3.0))
    assert selected(session) == set()


def test_a_rectangle_selects_what_can_be_seen_in_it(session: Session) -> None:
    choose(session, "Select")
    xs, ys = np.meshgrid(np.linspace(-0.3, 0.3, 24), np.linspace(-0.25, 0.25, 24))
    origins = np.stack([xs.ravel(), ys.ravel(), np.full(576, 5.0)], axis=1)
    rays = Rays(origins, np.tile((0.0, 0.0, -1.0), (576, 1)))
    session.tools.current.rectangle(rays)
    # The caster is below the base.
    assert {"base_link", "drivewhl_l_link", "drivewhl_r_link"} <= selected(session)
    assert "front_caster" not in selected(session)


def test_measuring_tells_the_distance_of_two_points(session: Session) -> None:
    choose(session, "Measure")
    tool = session.tools.current
    assert isinstance(tool, MeasureTool)
    tool.click(Ray(0, (1.0, 1.0, 5.0), (0.0, 0.0, -1.0)))
    assert tool.length is None
    tool.click(Ray(0, (2.0, 1.0, 5.0), (0.0, 0.0, -1.0)))
    assert tool.length == pytest.approx(1.0)
    assert session.tools.status == "[Length: 1m]"
    tool.click(Ray(0, (200.0, 1.0, 5.0), (0.0, 0.0, -1.0)))
    assert tool.length == pytest.approx(1.0), "a click beside everything is nothing"
    tool.click(Ray(0, (3.0, 1.0, 5.0), (0.0, 0.0, -1.0)))
    assert tool.length is None
    session.tools.escape()
    assert session.tools.current.label == "Move Camera"


def test_focus_looks_at_the_point_and_goes_back(session: Session) -> None:
    choose(session, "FocusCamera")
    session.tools.current.click(down(0.05, 0.05))
    focal = session.views.view.config.get("Focal Point")
    assert focal == pytest.approx((0.05, 0.05, 0.09), abs=1e-3)
    assert session.tools.current.label == "Move Camera"


def test_over_the_background_focus_looks_one_metre_ahead(session: Session) -> None:
    choose(session, "FocusCamera")
    up = Ray(0, session.views.camera.position, (0.0, 0.0, 1.0))
    session.tools.current.click(up)
    assert session.views.view.config.get("Distance") == pytest.approx(1.0)


def test_a_key_chooses_a_tool_and_leaves_it_again(session: Session) -> None:
    tools = session.tools
    tools.press(f"{PREFIX}Measure")
    assert tools.current.label == "Measure"
    tools.press(f"{PREFIX}Measure")
    assert tools.current.label == "Move Camera"
    tools.press(f"{PREFIX}Select")
    tools.press(f"{PREFIX}Measure")
    assert tools.current.label == "Select", "Select keeps the keys, as in RViz"
    tools.escape()
    assert tools.current.label == "Move Camera"


def test_settings_come_from_the_file_and_go_back(session: Session) -> None:
    tool = next(t for t in session.tools.tools if isinstance(t, MeasureTool))
    assert tool.config is not None and tool.config.get("Line color") == (1, 2, 3)
    session.tools.set_property(tool, "Line color", (4, 5, 6))
    assert "4; 5; 6" in session.config.to_yaml()
