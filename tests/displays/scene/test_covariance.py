"""The numbers of covariance shapes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sambot_viz.displays.scene.covariance import (
    THIN,
    CovarianceLook,
    covariance_solids,
)
from sambot_viz.geometry import rotation_from_xyzw

HERE = (1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
TURNED = (0.8, 0.0, 0.0, 0.6), (1.0, 2.0, 3.0)


def planar() -> np.ndarray:
    sigma = np.zeros((6, 6))
    sigma[0, 0], sigma[1, 1], sigma[5, 5] = 0.25, 0.04, 0.0685
    return sigma


def full() -> np.ndarray:
    return np.diag([0.1, 0.2, 0.3, 0.01, 0.02, 0.03])


def axis(wxyz: tuple[float, ...], of: int) -> np.ndarray:
    """An axis of a shape in the frame of the pose."""
    w, x, y, z = wxyz
    return np.array(rotation_from_xyzw((x, y, z, w)))[:, of]


def test_the_semi_axes_are_the_roots_of_the_eigenvalues() -> None:
    sigma = full()
    sigma[:3, :3] = [[0.75, 0.04, 0.1], [0.04, 0.7, 0.4], [0.1, 0.4, 0.5]]
    sphere = covariance_solids(sigma, *HERE)[0]
    assert sphere.kind == "sphere"
    assert [s / 2 for s in sphere.scale] == pytest.approx(
        [0.427, 0.852, 1.021], abs=1e-3
    )
    for i, semi in enumerate(s / 2 for s in sphere.scale):
        along = axis(sphere.wxyz, i)
        assert np.allclose(sigma[:3, :3] @ along, semi**2 * along)


def test_only_the_lower_triangle_is_read() -> None:
    sigma = planar()
    sigma[1, 0] = 0.05
    other = sigma.copy()
    other[0, 1] = 7
    assert covariance_solids(other, *HERE) == covariance_solids(sigma, *HERE)


def test_a_planar_pose_has_a_flat_ellipse_and_a_wedge() -> None:
    ellipse, wedge = covariance_solids(planar().ravel(), *HERE)
    assert sorted(ellipse.scale) == pytest.approx([THIN, 0.4, 1.0])
    assert (wedge.kind, wedge.color, wedge.alpha) == ("cone", (255, 255, 127), 0.5)
    # 15° on both sides, 1 m long.
    assert wedge.scale == pytest.approx((2 * 0.268, THIN, 1.0), abs=1e-3)
    tip = np.array(wedge.position) + axis(wedge.wxyz, 2) * 0.491
    base = np.array(wedge.position) - axis(wedge.wxyz, 2) * 0.509
    assert tip == pytest.approx([0, 0, 0], abs=1e-9)
    assert base == pytest.approx([1, 0, 0], abs=1e-9)
    assert abs(axis(wedge.wxyz, 0)) == pytest.approx([0, 1, 0])


def test_no_wedge_is_wider_than_89_degrees() -> None:
    sigma = planar()
    sigma[5, 5] = 100.0
    wedge = covariance_solids(sigma, *HERE, CovarianceLook(offset=2.0))[1]
    assert wedge.scale[0] == pytest.approx(4 * math.tan(math.radians(89)))


def test_discs_face_the_axes_of_the_pose() -> None:
    _, *discs = covariance_solids(full(), *TURNED, CovarianceLook(is_rgb=True))
    assert [d.color for d in discs] == [(255, 0, 0), (0, 255, 0), (0, 0, 255)]
    for i, disc in enumerate(discs):
        out = axis(TURNED[0], i)
        assert disc.kind == "cylinder"
        assert np.array(disc.position) == pytest.approx(np.array(TURNED[1]) + out)
        assert abs(axis(disc.wxyz, 2) @ out) == pytest.approx(1.0)
        assert disc.scale[2] == THIN


@pytest.mark.parametrize(
    ("disc", "certain", "uncertain", "along"),
    [
        (0, 5, 4, 2),
        (0, 4, 5, 1),
        (1, 5, 3, 2),
        (1, 3, 5, 0),
        (2, 4, 3, 0),
        (2, 3, 4, 1),
    ],
)
def test_a_disc_is_wide_along_rvizs_axis(
    disc: int, certain: int, uncertain: int, along: int
) -> None:
    sigma = full()
    sigma[certain, certain], sigma[uncertain, uncertain] = 0.0001, 0.04
    shape = covariance_solids(sigma, *HERE)[1 + disc]
    wide = int(np.argmax(shape.scale))
    assert shape.scale[wide] == pytest.approx(2 * math.tan(0.2))
    assert abs(axis(shape.wxyz, wide)[along]) == pytest.approx(1.0)


def test_fixed_shapes_do_not_turn_with_the_pose() -> None:
    local = covariance_solids(full(), *TURNED)
    fixed = covariance_solids(full(), *TURNED, CovarianceLook(is_local=False))
    assert fixed[0] == local[0]
    assert np.array(fixed[1].position) == pytest.approx((2.0, 2.0, 3.0))
    assert np.array(local[1].position) == pytest.approx((1.28, 2.96, 3.0))


def test_what_is_no_variance_hides_its_shape_only() -> None:
    sigma = full()
    sigma[0, 0] = -0.1
    assert [s.kind for s in covariance_solids(sigma, *HERE)] == 3 * ["cylinder"]
    sigma = full()
    sigma[5, 5] = math.nan
    assert [s.kind for s in covariance_solids(sigma, *HERE)] == ["sphere", "cylinder"]
    off = CovarianceLook(has_position=False, has_orientation=False)
    assert covariance_solids(full(), *HERE, off) == []


def test_a_variance_of_zero_is_flat_and_not_hidden() -> None:
    sigma = full()
    sigma[:3, :3] = np.outer([1, 2, 3], [1, 2, 3])
    sphere = covariance_solids(sigma, *HERE)[0]
    assert sorted(sphere.scale)[:2] == [THIN, THIN]
