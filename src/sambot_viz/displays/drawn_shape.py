"""What a display has drawn, as triangles: for finding what is under the cursor."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
import numpy.typing as npt

from sambot_viz.geometry import Matrix

Owner = tuple[Literal["link", "frame"], str]
"""What a click selects: a link of the robot, or a TF frame."""


class Triangles(Protocol):
    """Triangles in arrays, as a mesh file or a unit shape has them."""

    @property
    def vertices(self) -> npt.NDArray[np.float32]:
        """(V, 3) [m]."""
        ...

    @property
    def faces(self) -> npt.NDArray[np.uint32]:
        """(F, 3) indices of vertices, counter-clockwise seen from outside."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class DrawnShape:
    """Triangles that are on the screen.

    Attributes:
        triangles: the same object as long as they do not change.
        T_frame_shape: (4, 4) their pose at their frame; it may scale.
        frame: the frame they are drawn at; None for the fixed frame.
        owner: what a click on them selects; None when that is nothing.
        solid: False for lines, which can be seen through.
    """

    triangles: Triangles
    T_frame_shape: Matrix
    frame: str | None
    owner: Owner | None = None
    solid: bool = True
