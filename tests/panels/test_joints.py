"""The Joints panel: exact values, degrees, notes, poses, text, large robots."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.panels.joints import slider_step

Join = Callable[[Visualizer], ProtocolClient]
LEFT = "drivewhl_l_joint"


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0) as viz:
        yield viz


@pytest.fixture
def join(protocol: Callable[[int], ProtocolClient]) -> Join:
    """Connect one client that has received everything there is."""

    def connect(viz: Visualizer) -> ProtocolClient:
        client = protocol(urlsplit(viz.url).port or 0)
        client.settle(viser_server(viz))
        return client

    return connect


def arm(folder: Path, joints: str) -> Path:
    """A model of links a, b, c … and some joints."""
    links = "".join(f'<link name="{name}"/>' for name in "abc")
    path = folder / "arm.urdf"
    path.write_text(f'<robot name="arm">{links}{joints}</robot>')
    return path


def joint(name: str, kind: str, ends: str, inside: str) -> str:
    parent, child = ends
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="0 0 1"/>{inside}</joint>'
    )


LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def html(client: ProtocolClient) -> str:
    return "\n".join(
        str(m.fields.get(key, {}).get("content", ""))
        for m in client.messages
        for key in ("props", "updates")
    )


def test_a_typed_value_is_taken_exactly(viz: Visualizer, join: Join) -> None:
    client = join(viz)
    client.set_value(client.uuid_of(LEFT), 0.123456789)
    client.wait_until(lambda: viz.joint_positions[LEFT] == 0.123456789)
    slider = next(
        m
        for m in client.messages
        if m.type == "GuiSliderMessage" and m.fields["props"]["label"] == LEFT
    )
    updates = [
        m.fields["updates"]["precision"]
        for m in client.messages
        if m.fields.get("uuid") == slider.fields["uuid"]
        and "precision" in m.fields.get("updates", {})
    ]
    assert [slider.fields["props"]["precision"], *updates][-1] == 12


def test_degrees_are_only_on_the_screen(viz: Visualizer, join: Join) -> None:
    client = join(viz)
    client.set_value(client.uuid_of("Degrees"), True)
    client.settle(viser_server(viz))
    client.set_value(client.uuid_of(LEFT), 90.0)
    client.wait_until(lambda: viz.joint_positions[LEFT] != 0)
    assert viz.joint_positions[LEFT] == pytest.approx(math.pi / 2, abs=1e-15)
    client.set_value(client.uuid_of(LEFT), 180.0)
    client.wait_until(lambda: viz.joint_positions[LEFT] == math.pi)


def test_a_value_over_the_limit_and_a_follower_are_told(
    tmp_path: Path, join: Join
) -> None:
    mimic = LIMIT + '<mimic joint="j" multiplier="2" offset="0.1"/>'
    model = arm(
        tmp_path,
        joint("j", "revolute", "ab", LIMIT) + joint("k", "revolute", "bc", mimic),
    )
    with Visualizer(model, port=0) as viz:
        client = join(viz)
        assert "k" not in client.widgets
        viz.set_joint_positions({"j": 1.5})
        client.wait_until(lambda: "j is over its limit: 1.5 rad" in html(client))
        assert "k = 3.1 rad (follows 2 × j + 0.1)" in html(client)
        # The slider stands at its end; the joint stays where the program set it.
        assert client.value_of("j") == 1.0
        assert viz.joint_positions["j"] == 1.5


def test_the_same_seed_gives_the_same_pose(viz: Visualizer, join: Join) -> None:
    client = join(viz)
    client.set_value(client.uuid_of("Seed"), "7")
    poses: list[float] = []
    for _ in range(2):
        before = viz.joint_positions[LEFT]
        client.set_value(client.uuid_of("Randomize"), True)
        client.wait_until(lambda b=before: viz.joint_positions[LEFT] != b)
        poses.append(viz.joint_positions[LEFT])
        viz.set_joint_positions({LEFT: 0.0})
    assert poses[0] == poses[1]


def test_a_pose_is_saved_beside_the_model_and_taken_again(
    tmp_path: Path, join: Join
) -> None:
    model = arm(tmp_path, joint("j", "revolute", "ab", LIMIT))
    model.write_text(model.read_text().replace('<link name="c"/>', ""))
    with Visualizer(model, port=0) as viz:
        client = join(viz)
        viz.set_joint_positions({"j": 0.25})
        client.set_value(client.uuid_of("Pose name"), "half")
        client.set_value(client.uuid_of("Save pose"), True)
        client.wait_until(lambda: client.value_of("Pose") == "half")
        assert "half" in (tmp_path / "arm.poses.yaml").read_text()
    with Visualizer(model, port=0) as viz:
        client = join(viz)
        client.set_value(client.uuid_of("Pose"), "half")
        client.wait_until(lambda: viz.joint_positions["j"] == 0.25)
        client.set_value(client.uuid_of("Pose"), "(start values)")
        client.wait_until(lambda: viz.joint_positions["j"] == 0.0)


def test_the_positions_can_be_copied_as_yaml_and_as_a_command(
    viz: Visualizer, join: Join
) -> None:
    client = join(viz)
    viz.set_joint_positions({LEFT: 0.5})
    client.set_value(client.uuid_of("As yaml"), True)
    client.wait_until(lambda: "position:\n- 0.5\n- 0.0" in client.value_of("Text"))
    client.set_value(client.uuid_of("As a ros2 topic pub command"), True)
    client.wait_until(
        lambda: client.value_of("Text").startswith("ros2 topic pub --once")
    )


def test_a_robot_of_300_joints_has_forty_rows_and_a_search(
    tmp_path: Path, join: Join
) -> None:
    names = [f"l{i}" for i in range(301)]
    links = "".join(f'<link name="{name}"/>' for name in names)
    joints = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/>'
        f'<child link="l{i + 1}"/>{LIMIT}</joint>'
        for i in range(300)
    )
    model = tmp_path / "snake.urdf"
    model.write_text(f'<robot name="snake">{links}{joints}</robot>')
    with Visualizer(model, port=0) as viz:
        client = join(viz)
        assert "j39" in client.widgets
        assert "j40" not in client.widgets
        assert "and 260 more: search for them" in html(client)
        searches = [
            m.fields["uuid"]
            for m in client.messages
            if m.fields.get("props", {}).get("hint") == "Part of the joints' names."
        ]
        client.set_value(searches[-1], "j299")
        client.wait_until(lambda: "j299" in client.widgets)


def test_holding_a_wheels_button_turns_it_and_letting_go_stops_it(
    viz: Visualizer, join: Join
) -> None:
    client = join(viz)
    motion = viz._server.sessions()[0].motion  # pyright: ignore[reportPrivateUsage]
    button = client.uuid_of(f"↻ {LEFT}")
    for _ in range(3):
        client.send("GuiButtonHoldMessage", uuid=button, frequency=10.0)
    client.wait_until(lambda: viz.joint_positions[LEFT] > 0)
    client.wait_until(lambda: not motion.moving)
    assert viz.joint_positions[LEFT] < 1.0


def test_the_arrow_of_the_positive_direction_comes_with_the_second_step(
    viz: Visualizer, join: Join
) -> None:
    client = join(viz)

    def arrows() -> int:
        return sum(
            str(m.fields.get("name", "")).endswith("/~positive")
            and m.type == "ArrowMessage"
            for m in client.messages
        )

    slider = client.uuid_of(LEFT)
    client.set_value(slider, 0.5)
    client.settle(viser_server(viz))
    assert arrows() == 0
    client.set_value(slider, 0.6)
    client.set_value(slider, 0.7)
    client.wait_until(lambda: arrows() == 1)


@pytest.mark.parametrize(
    ("lower", "upper"),
    [(-math.pi, math.pi), (-1.9198, 0.5), (-0.02, 3.0), (-180.0, 180.0), (-1e-4, 2e-4)],
)
def test_zero_is_a_step_of_every_slider_that_has_it(lower: float, upper: float) -> None:
    step = slider_step(lower, upper)
    steps = -lower / step
    assert steps == pytest.approx(round(steps), abs=1e-6)
    assert (upper - lower) / 20000 < step < (upper - lower) / 500
