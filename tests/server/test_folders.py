"""Which folders of the server are in the pages of those who do not control it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer

Protocol = Callable[..., ProtocolClient]
MODEL = """<robot name="r">
  <link name="base">
    <visual><geometry><mesh filename="FOLDER/meshes/missing.stl"/></geometry></visual>
    <visual><geometry><mesh filename="package://none/a.stl"/></geometry></visual>
    <inertial><mass value="1"/></inertial>
  </link>
  <link name="tip"/>
  <joint name="j" type="revolute">
    <parent link="base"/><child link="tip"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """A model with errors that are about files of the server."""
    model = tmp_path / "server" / "r.urdf"
    model.parent.mkdir()
    model.write_text(MODEL.replace("FOLDER", str(model.parent)), "utf-8")
    return model


OPTIONS: dict[str, dict[str, Any]] = {
    "presented": {"presenter": "teach-the-class"},
    "private": {"session": "private"},
}


@pytest.mark.parametrize("session", ["presented", "private", "copy", "shared"])
def test_the_problems_of_viewers_and_visitors_name_no_folder_of_the_server(
    session: str, model: Path, protocol: Protocol
) -> None:
    options = OPTIONS.get(session, {})
    with Visualizer(model, port=0, watch=False, **options) as viz:
        path = "/copy/" if session == "copy" else ""
        client = protocol(viz.viser.get_port(), path=path)
        client.settle(viser_server(viz))
        for row in problems(client):
            if row.get("lazy"):
                client.act("problems/unfold", row["id"])
        client.settle(viser_server(viz))
        seen = json.dumps(problems(client))
        assert "missing.stl was not found" in seen
        assert "r.urdf:3:23" in seen
        assert "package://none/a.stl" in seen
        assert (str(model.parent) in seen) == (session == "shared")


def test_the_place_of_poses_is_whole_only_where_there_are_no_viewers(
    model: Path, protocol: Protocol
) -> None:
    for options in (OPTIONS["presented"], {}):
        with Visualizer(model, port=0, watch=False, **options) as viz:
            client = protocol(viz.viser.get_port())
            client.settle(viser_server(viz))
            place = client.row("poses/place")["value"]
            assert place.endswith("r.poses.yaml.")
            assert (str(model.parent) in place) == (not options)


def problems(client: ProtocolClient) -> list[Any]:
    """The rows of the Problems panel."""
    return [row for row in client.rows.values() if row["panel"] == "problems"]
