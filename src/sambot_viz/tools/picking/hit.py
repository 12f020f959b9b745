"""What a click or a selection means: a link of the robot, or a TF frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from sambot_viz.tools.picking.rays import Array


@dataclass(frozen=True, slots=True)
class Selectable:
    """Something that can be selected: a link of the robot, or a TF frame."""

    kind: Literal["link", "frame"]
    name: str


@dataclass(frozen=True, slots=True, eq=False)
class Hit:
    """What is under the cursor.

    Attributes:
        point: the nearest point of what is drawn, in the fixed frame, (3,) [m]; None
            for the background.
        item: the link or frame; None for the grid and the background.
    """

    point: Array | None
    item: Selectable | None
