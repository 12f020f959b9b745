"""A hand that uses the tools of a page, which looks down on the ground."""

from __future__ import annotations

import math

from inside import viser_server
from protocol_client import ProtocolClient

from sambot_viz import Visualizer


class Hand:
    """A browser whose camera looks down from 5 m, 4.1 m high and 5.5 m wide."""

    WIDE = 2 * 5.0 * math.tan(0.785 / 2) * 640 / 480

    def __init__(self, viz: Visualizer, client: ProtocolClient) -> None:
        self.viz, self.client = viz, client
        client.settle(viser_server(viz))
        self.look((0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 5.0))

    def look(
        self,
        wxyz: tuple[float, float, float, float],
        position: tuple[float, float, float],
    ) -> None:
        """Turn the camera, which has x to the right and z forward."""
        self.client.send(
            "ViewerCameraMessage",
            wxyz=wxyz,
            position=position,
            fov=0.785,
            near=0.01,
            far=1000.0,
            image_height=480,
            image_width=640,
            look_at=(0.0, 0.0, 0.0),
            up_direction=(0.0, 1.0, 0.0),
        )
        self.client.settle(viser_server(self.viz))

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Where a point of the ground is in the picture [m]."""
        return 0.5 + x / self.WIDE, 0.5 - y / self.WIDE * 640 / 480

    def act(self, name: str, *values: object) -> None:
        self.client.act(name, *values)
        self.client.settle(viser_server(self.viz))

    def choose(self, label: str) -> None:
        self.act("tools/choose", label)

    def drag(
        self,
        *places: tuple[float, float],
        ends: bool = True,
        key: str | None = None,
    ) -> None:
        begin, *_, last = places[0], *places
        for place in places:
            self.client.edit("tools/drag", [*begin, *place, key])
        if ends:
            self.act("tools/drop", *begin, *last, key)
        self.client.settle(viser_server(self.viz))

    @property
    def said(self) -> str:
        return str(self.client.row("tools/hint")["value"]["text"])

    @property
    def labels(self) -> list[str]:
        return [tool["name"] for tool in self.client.row("tools/list")["value"]]

    @property
    def current(self) -> str:
        listed = self.client.row("tools/list")["value"]
        return next(tool["name"] for tool in listed if tool["current"])

    def hover(self, place: tuple[float, float]) -> bool:
        """Rest on a place; return whether a press there is a drag of the tool."""
        self.act("tools/hover", *place)
        over = self.client.row("tools/over")["value"]
        assert (over["x"], over["y"]) == place
        return bool(over["holds"])

    def draws(self) -> bool:
        """Whether there is an arrow."""
        names = [m.fields.get("name", "") for m in self.client.messages]
        last = [m for m in self.client.messages if m.fields.get("name") == "/~pose"]
        assert names
        return bool(last) and last[-1].type != "RemoveSceneNodeMessage"
