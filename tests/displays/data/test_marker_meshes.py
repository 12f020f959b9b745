"""How meshes of markers are coloured: by their files, tinted, or by the marker."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sambot_viz.displays.data.markers.marker_meshes import look_of
from sambot_viz.meshes.mesh import MeshPart, Texture

CORNERS = np.eye(3, dtype=np.float32)
FACES = np.array([[0, 1, 2]], np.uint32)
OWN = (0.0, 1.0, 0.0, 0.5)


def colored(r: float, g: float, b: float, a: float, *, embedded: bool = True) -> Any:
    color = SimpleNamespace(r=r, g=g, b=b, a=a)
    return SimpleNamespace(color=color, mesh_use_embedded_materials=embedded)


@pytest.mark.parametrize(
    ("marker", "rgba"),
    [
        # The colour alone.
        (colored(1, 0, 0, 0.8, embedded=False), (1, 0, 0, 0.8)),
        # All zeros keep the material, opaque.
        (colored(0, 0, 0, 0), (0, 1, 0, 1)),
        # Half of the colour over the material, and never more.
        (colored(1, 0, 0, 1), (0.5, 0.5, 0, 1)),
        (colored(1, 0, 0, 0.4), (0.4 / 0.64, 0.24 / 0.64, 0, 0.64)),
    ],
)
def test_a_material_is_tinted_as_rviz_does(
    marker: Any, rgba: tuple[float, ...]
) -> None:
    part = MeshPart(CORNERS, FACES, rgba=OWN)
    assert look_of(marker).of(part) == (pytest.approx(rgba), False, None)


def test_a_texture_keeps_its_colours_below_the_tint() -> None:
    part = MeshPart(
        CORNERS, FACES, uv=CORNERS[:, :2], texture=Texture(b"", "image/png", 1, 1)
    )
    rgba, textured, over = look_of(colored(1, 0, 0, 0.8)).of(part)
    assert (rgba, textured, over) == ((1, 1, 1, 0.8), True, (1, 0, 0, 0.5))


def test_a_part_without_a_material_has_the_colour_alone() -> None:
    part = MeshPart(CORNERS, FACES)
    for alpha, shown in ((1.0, 1.0), (0.8, 0.5), (0.3, 0.3)):
        look = look_of(colored(1, 0, 0, alpha)).of(part)
        assert look == ((1, 0, 0, shown), False, None)
