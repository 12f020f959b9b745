"""The product of the transforms along a way through the tree."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from sambot_viz.frames.transform import Transform
from sambot_viz.geometry import (
    Matrix,
    Xyzw,
    inverse_matrix,
    xyzw_from_matrix,
    xyzw_product,
)


class _Seen(Transform):
    """A pose found along several edges, which its quaternion's sign depends on."""

    _below: tuple[Transform, ...]
    _above: tuple[Transform, ...]

    @cached_property
    def rotation_xyzw(self) -> npt.NDArray[np.float64]:
        # tf2 multiplies quaternions along the chain; only the sign of that product
        # is taken from there, the matrix has the better digits.
        product = _rotation(self._above)
        x, y, z, w = xyzw_product(
            (-product[0], -product[1], -product[2], product[3]), _rotation(self._below)
        )
        xyzw = np.array(xyzw_from_matrix(self.matrix))
        if np.dot(xyzw, (x, y, z, w)) < 0:
            xyzw = -xyzw
        xyzw.flags.writeable = False
        return xyzw


def _rotation(transforms: tuple[Transform, ...]) -> Xyzw:
    product: Xyzw = (0.0, 0.0, 0.0, 1.0)
    for transform in transforms:
        x, y, z, w = transform.rotation_xyzw.tolist()
        product = xyzw_product((x, y, z, w), product)
    return product


def compose(below: tuple[Transform, ...], above: tuple[Transform, ...]) -> Transform:
    """The pose of a source in a target, from their ways up to a common frame.

    Args:
        below: T_parent_child of each step from the source up.
        above: T_parent_child of each step from the target up.

    Returns:
        T_target_source.
    """
    matrix = _product(below)
    if above:
        matrix = inverse_matrix(_product(above)).dot(matrix)
    matrix.flags.writeable = False
    seen = _Seen.trusted(matrix)
    seen.__dict__.update(_below=below, _above=above)
    return seen


def _product(transforms: tuple[Transform, ...]) -> Matrix:
    """T_top_bottom of transforms that are given from the bottom to the top."""
    if not transforms:
        return Transform.identity().matrix
    matrix = transforms[-1].matrix
    for transform in transforms[-2::-1]:
        matrix = matrix.dot(transform.matrix)
    return matrix
