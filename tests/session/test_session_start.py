"""What a robot begins with: joint values, frames, wheels, named poses."""

from __future__ import annotations

from pathlib import Path

import pytest
from inside import session_of
from work import calls_of

from sambot_viz import JointError, Visualizer, bundled, load_robot
from sambot_viz.bundled import poses_beside

LEFT, RIGHT = "drivewhl_l_joint", "drivewhl_r_joint"


def test_zeros_recorded_and_single_positions_count_in_this_order(
    tmp_path: Path,
) -> None:
    file = tmp_path / "state.yaml"
    file.write_text(f"name: [{LEFT}, {RIGHT}, foreign]\nposition: [0.1, 0.2, 0.3]\n")
    with Visualizer(
        port=0, zeros={LEFT: 1.0}, joint_state=file, joint_positions={RIGHT: 0.5}
    ) as viz:
        assert viz.joint_positions == {LEFT: 0.1, RIGHT: 0.5}
        session = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
        session.robot.center()
        assert viz.joint_positions == {LEFT: 1.0, RIGHT: 0.0}


def test_a_joint_that_is_not_there_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(JointError, match="did you mean 'drivewhl_l_joint'"):
        Visualizer(port=0, joint_positions={"drivewhl_l_jont": 1.0})


def test_static_transforms_are_there_and_outlive_a_reload() -> None:
    text = "0.1 0 0.2 0 0 0 base_link base_laser"
    with Visualizer(port=0, static_transforms=[text]) as viz:
        session = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
        assert session.robot.model is not None
        session.show_robot(session.robot.model)
        T = viz.frames.lookup("base_link", "base_laser")
        assert T.translation.tolist() == [0.1, 0.0, 0.2]
        session.frames.remove("base_laser")
        assert "base_laser" not in viz.frames


def test_a_frame_taken_from_a_joint_goes_back_to_it() -> None:
    with Visualizer(port=0) as viz:
        session = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
        before = viz.frames.lookup("base_link", "front_caster")
        viz.set_static_transform("map", "front_caster", (1.0, 0.0, 0.0))
        assert viz.frames.parent("front_caster") == "map"
        session.frames.remove("front_caster")
        assert viz.frames.lookup("base_link", "front_caster") == before
        assert "map" not in viz.frames


def test_poses_are_kept_beside_the_model_or_where_the_program_was_started() -> None:
    folder = Path("robots")
    assert poses_beside(folder / "arm.urdf.xacro") == folder / "arm.poses.yaml"
    assert poses_beside(folder / "arm.urdf") == folder / "arm.poses.yaml"
    here = Path.cwd() / "sam_bot.poses.yaml"
    assert poses_beside(bundled.model_path()) == here


def test_a_floating_joint_is_told_in_the_problems(tmp_path: Path) -> None:
    model = tmp_path / "floating.urdf"
    model.write_text(
        '<robot name="r"><link name="a"/><link name="b"/>'
        '<joint name="j" type="floating"><parent link="a"/><child link="b"/></joint>'
        "</robot>"
    )
    with Visualizer(model, port=0) as viz:
        session = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
        problem = next(
            p for p in session.problems.of_model if p.code == "floating-joint"
        )
        assert "ROS publishes no transform" in problem.message
        assert viz.frames.can_lookup("a", "b")


def test_wheels_that_do_not_exist_are_told_in_the_problems() -> None:
    with Visualizer(port=0, left_wheel="lft", right_wheel=RIGHT) as viz:
        session = viz._server.sessions.all()[0]  # pyright: ignore[reportPrivateUsage]
        problem = next(p for p in session.problems.of_model if p.code == "drive-wheels")
        assert "no continuous joint 'lft'" in problem.message


def star(links: int) -> str:
    """A robot of boxes, all of them on joints of the first one."""
    box = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    parts = [f'<link name="l{i}">{box}</link>' for i in range(links)]
    for i in range(1, links):
        parts.append(
            f'<joint name="j{i}" type="continuous"><parent link="l0"/>'
            f'<child link="l{i}"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/></joint>'
        )
    return f'<robot name="star of {links}">{"".join(parts)}</robot>'


def test_each_link_takes_the_same_work_to_be_shown(tmp_path: Path) -> None:
    file, work = tmp_path / "star.urdf", list[int]()
    for links in (80, 120, 160):
        file.write_text(star(40))
        with Visualizer(file, port=0, watch=False) as viz:
            file.write_text(star(links))
            session, robot = session_of(viz), load_robot(file)
            work.append(calls_of(lambda s=session, r=robot: s.show_robot(r)))
    first, second = work[1] - work[0], work[2] - work[1]
    assert second == pytest.approx(first, rel=0.05)
    # More than half of that is viser's, which makes three nodes for a link.
    assert second / 40 < 1500
