"""Shapes out of files that cannot be used, and what is said about them."""

from __future__ import annotations

from pathlib import Path

from patience import patience

from sambot_viz import Visualizer


def test_a_box_with_a_broken_texture_is_drawn_without_it_and_that_is_said(
    tmp_path: Path,
) -> None:
    (tmp_path / "wood.png").write_bytes(b"no image")
    model = tmp_path / "robot.urdf"
    model.write_text(
        '<robot name="r"><link name="a"><visual><geometry><box size="1 1 1"/>'
        '</geometry><material name="w"><color rgba="0 1 0 1"/>'
        '<texture filename="wood.png"/></material></visual></link></robot>'
    )
    with Visualizer(model) as viz:
        server = viz._server  # pyright: ignore[reportPrivateUsage]
        server.sessions.wait_for_meshes(patience(20))
        session = server.sessions.all()[0]
        robot = next(d for d in session.scene.displays if d.config.name == "RobotModel")
        assert [p.code for p in robot.problems] == ["texture-unreadable"]
        assert robot.status.level == "Error"
        assert "wood.png cannot be used" in robot.status.rows["URDF"].text
