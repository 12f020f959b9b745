"""The Drive panel: when it is there, and what its widgets do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer
from sambot_viz.session import Session

Join = Callable[[Visualizer], ProtocolClient]


@pytest.fixture
def viz() -> Iterator[Visualizer]:
    with Visualizer(port=0) as viz:
        yield viz


@pytest.fixture
def session(viz: Visualizer) -> Session:
    return viz._server.sessions()[0]  # pyright: ignore[reportPrivateUsage]


@pytest.fixture
def join(protocol: Callable[[int], ProtocolClient]) -> Join:
    """Connect one client that has received everything there is."""

    def connect(viz: Visualizer) -> ProtocolClient:
        client = protocol(urlsplit(viz.url).port or 0)
        client.settle(viser_server(viz))
        return client

    return connect


def test_a_robot_without_wheels_has_no_drive_panel(
    tmp_path: Path, viz: Visualizer, join: Join
) -> None:
    assert "Linear [m/s]" in join(viz).widgets
    arm = tmp_path / "arm.urdf"
    arm.write_text('<robot name="arm"><link name="base"/></robot>')
    with Visualizer(arm, port=0) as armed:
        assert "Linear [m/s]" not in join(armed).widgets


def test_the_velocity_slider_drives_until_it_is_back_at_zero(
    viz: Visualizer, session: Session, join: Join
) -> None:
    client = join(viz)
    slider = client.uuid_of("Linear [m/s]")
    client.set_value(slider, 0.5)
    client.wait_until(lambda: session.motion.drive.pose.x > 0.05)
    client.set_value(slider, 0.0)
    client.wait_until(lambda: not session.motion.moving)
    client.settle(viser_server(viz))
    assert viz.frames.parent("base_link") == "odom"
    assert session.motion.drive.pose.y == pytest.approx(0.0)


def test_a_velocity_beyond_the_slider_is_clamped(
    viz: Visualizer, session: Session, join: Join
) -> None:
    client = join(viz)
    client.set_value(client.uuid_of("Angular [rad/s]"), 99.0)
    client.wait_until(lambda: session.motion.drive.w == 2.0)
    session.motion.stop()


def test_a_root_that_hangs_elsewhere_is_not_taken_away_from_there(
    viz: Visualizer, session: Session, join: Join
) -> None:
    viz.set_static_transform("map", "base_link")
    client = join(viz)
    client.set_value(client.uuid_of("Linear [m/s]"), 0.5)
    client.wait_until(
        lambda: any(
            "is attached to &#x27;map&#x27; already" in str(m.fields.get("updates", ""))
            for m in client.messages
        )
    )
    assert not session.motion.moving
    assert viz.frames.parent("base_link") == "map"
