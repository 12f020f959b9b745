"""ParticleCloud of Nav2: the weight of a particle is its length."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from made_messages import Make
from made_recording import OF_NAV2

Open = Callable[..., Any]
CLOUD, PARTICLE = "nav2_msgs/msg/ParticleCloud", "nav2_msgs/msg/Particle"
KIND = "nav2_rviz_plugins/ParticleCloud"


def cloud(*weights: float, x: float = 1.0) -> Make:
    def make(types: Any) -> tuple[str, str, object]:
        point = types["geometry_msgs/msg/Point"](x, 0.0, 0.0)
        turn = types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
        pose = types["geometry_msgs/msg/Pose"](point, turn)
        time = types["builtin_interfaces/msg/Time"](0, 0)
        header = types["std_msgs/msg/Header"](time, "map")
        particles = [types[PARTICLE](pose, weight) for weight in weights]
        return "/a", CLOUD, types[CLOUD](header, particles)

    return make


@pytest.fixture
def shown(messages: Open) -> Open:
    """Opens clouds in their display."""

    def open_clouds(*made: Make, **values: Any) -> Any:
        values = {"Class": KIND, **values}
        return messages("ParticleCloud", *made, definitions=OF_NAV2, **values)

    return open_clouds


def node(opened: Any) -> Any:
    (name,) = opened.node_names()
    scene = opened.viz.viser.scene
    return scene._handle_from_node_name[name]  # pyright: ignore[reportPrivateUsage]


def lengths(opened: Any) -> Sequence[float]:
    return np.asarray(node(opened).batched_scales)[:, 0].tolist()


def test_arrows_are_as_long_as_their_weights_say(shown: Open) -> None:
    opened = shown(cloud(0.0, 0.5, 1.0, 7.0, -1.0), Shape="Arrow (3D)")
    assert lengths(opened) == pytest.approx([0.02, 0.16, 0.3, 0.3, 0.02])
    opened.set("Max Arrow Length", 1.02)
    assert lengths(opened)[2] == pytest.approx(1.02)
    # The longest is never shorter than the shortest.
    opened.set("Max Arrow Length", 0.0)
    assert lengths(opened) == pytest.approx([0.02] * 5)


def test_axes_are_as_long_too(shown: Open) -> None:
    opened = shown(cloud(0.0, 1.0), Shape="Axes")
    scales = np.asarray(node(opened).batched_scales)
    assert scales[:, 2] == pytest.approx([0.02, 0.3] * 3)
    assert scales[:, 0] == pytest.approx([0.02 * 0.0435, 0.3 * 0.0435] * 3)
    assert np.asarray(node(opened).batched_positions)[1] == pytest.approx((1.15, 0, 0))


def test_flat_arrows_end_at_their_lengths(shown: Open) -> None:
    opened = shown(cloud(1.0))
    assert opened.glb()
    numbers = np.frombuffer(opened.glb()[-400:], np.float32)
    assert 1.3 in np.round(numbers.astype(float), 5)


@pytest.mark.parametrize("made", [cloud(math.nan), cloud(1.0, x=math.inf)])
def test_numbers_that_are_none_are_refused(shown: Open, made: Make) -> None:
    opened = shown(made)
    assert not opened.node_names()
    assert any("invalid floating point" in text for _, text in opened.statuses.values())


def test_a_cloud_without_particles_is_empty(shown: Open) -> None:
    opened = shown(cloud(1.0), cloud())
    assert not opened.node_names()
