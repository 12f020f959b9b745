"""The colour transformers of RViz: from the fields of points to their colours."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from sambot_viz.displays.data.cloud.cloud import Cloud, Values
from sambot_viz.displays.scene.solids import Rgb
from sambot_viz.geometry import Matrix

Colors: TypeAlias = npt.NDArray[np.uint8]
Floats: TypeAlias = npt.NDArray[np.float64]

WHITE: Rgb = (255, 255, 255)
_NO_RANGE, _NO_SPAN = 1e20, 0.001
"""In place of a range of 0: of intensities, and of coordinates."""
_FARTHEST = 999_999.0
_AXES = "XYZ"


@dataclass(frozen=True, slots=True)
class ColorOptions:
    """The user's settings for the colours of points.

    Attributes:
        transformer: "Intensity", "AxisColor", "FlatColor", "RGB8" or "RGBF32"; another
            text chooses as RViz does.
        color: of FlatColor, 0 to 255.
        channel: the field of Intensity.
        is_rainbow: whether to use a rainbow instead of two colours.
        is_inverted: whether the rainbow is reversed.
        least_color: of the least intensity, 0 to 255.
        most_color: of the greatest intensity, 0 to 255.
        intensities: the bounds; None takes those of the message.
        axis: "X", "Y" or "Z".
        coordinates: the bounds [m]; None takes those of the message.
        in_fixed_frame: whether coordinates are those in the fixed frame.
    """

    transformer: str = ""
    color: Rgb = WHITE
    channel: str = "intensity"
    is_rainbow: bool = True
    is_inverted: bool = False
    least_color: Rgb = (0, 0, 0)
    most_color: Rgb = WHITE
    intensities: tuple[float, float] | None = None
    axis: str = "Z"
    coordinates: tuple[float, float] | None = None
    in_fixed_frame: bool = True


_STEPS = 5 * 255
"""Number of colours of the rainbow less one: 255 from each corner to the next."""


@cache
def _rainbow_table() -> Colors:
    """Return all colours of the rainbow, (1276, 3) uint8, from magenta to red."""
    height = np.arange(_STEPS + 1) / 255 + 1
    part = np.floor(height)
    rest = height - part
    rest = np.where(part % 2 == 0, 1 - rest, rest)
    n, zero, one = 1 - rest, np.zeros_like(rest), np.ones_like(rest)
    parts = [part <= 1, part == 2, part == 3, part == 4, part >= 5]
    red, green, blue = (
        np.select(parts, channel)
        for channel in (
            (n, zero, zero, n, one),
            (zero, n, one, one, n),
            (one, one, n, zero, zero),
        )
    )
    table = np.stack([red, green, blue], axis=1)
    return np.round(255 * table).astype(np.uint8)


@cache
def _rainbow_pixels() -> npt.NDArray[np.uint32]:
    """Return the same with a fourth byte, each colour as one number, (1276,)."""
    rows = np.pad(_rainbow_table(), ((0, 0), (0, 1)), constant_values=255)
    return np.frombuffer(rows.tobytes(), np.uint32)


def rainbow(values: Floats) -> Colors:
    """Return RViz's rainbow: 0 is magenta, 0.2 blue, …, 0.8 yellow, 1 red.

    Args:
        values: (N,); values outside of 0 to 1 are clamped.

    Returns:
        (N, 3) uint8.
    """
    nearest = _clipped(values)
    nearest *= _STEPS
    nearest -= 0.5
    # Whole pixels are taken: of three bytes each it takes four times as long.
    pixels: Any = _rainbow_pixels().take(
        np.ceil(nearest, out=nearest).astype(np.uint16)
    )
    return pixels.view(np.uint8).reshape(-1, 4)[:, :3]


def transformers_of(cloud: Cloud) -> tuple[str, ...]:
    """Return the transformers that a cloud has the fields for, sorted."""
    found = ["AxisColor", "FlatColor", "Intensity"]
    if _packed(cloud) is not None:
        found.append("RGB8")
    if all(_is_float(cloud.fields.get(name)) for name in "rgb"):
        found.append("RGBF32")
    return tuple(found)


def transformer_of(cloud: Cloud, wanted: str) -> str:
    """Return the transformer that colours a cloud: the wanted one, or RViz's choice."""
    known = transformers_of(cloud)
    if wanted in known:
        return wanted
    return "RGB8" if "RGB8" in known else "Intensity"


def colors_of(cloud: Cloud, options: ColorOptions, T_fixed_cloud: Matrix) -> Colors:
    """Return the colour of each point.

    Args:
        cloud: the points.
        options: what was set.
        T_fixed_cloud: (4, 4), the pose of the points in the fixed frame.

    Returns:
        (N, 4) uint8, (N, 3) where no point has an alpha, or (1, 3) for all points.
    """
    transformer = transformer_of(cloud, options.transformer)
    make: dict[str, Callable[[], Colors]] = {
        "Intensity": lambda: _intensity(cloud, options),
        "AxisColor": lambda: _axis_color(cloud, options, T_fixed_cloud),
        "FlatColor": lambda: np.array([options.color], np.uint8),
        "RGB8": lambda: _rgb8(cloud),
        "RGBF32": lambda: _rgbf32(cloud),
    }
    return make[transformer]()


def intensities_of(cloud: Cloud, channel: str) -> Floats | None:
    """Return the values that Intensity colours, (N,); None when there are none."""
    values = cloud.fields.get(channel)
    if values is None and channel == "intensity":
        values = cloud.fields.get("intensities")
    if values is None:
        return None
    if values.dtype.kind == "i":
        # RViz reads whole numbers as if they had no sign.
        unsigned: Any = f"<u{values.dtype.itemsize}"
        return values.astype(unsigned).astype(np.float64)
    return values.astype(np.float64)


def _intensity(cloud: Cloud, options: ColorOptions) -> Colors:
    values = intensities_of(cloud, options.channel)
    if values is None:
        return np.array([WHITE], np.uint8)
    low, high = options.intensities or _bounds(values)
    span = high - low
    if span == 0:
        span = _NO_RANGE
    with np.errstate(over="ignore", invalid="ignore"):
        part = values - low
        part /= span
    if options.is_rainbow:
        if not options.is_inverted:
            np.subtract(1, part, out=part)
        return rainbow(part)
    part = _clipped(part)[:, None]
    most, least = np.array(options.most_color), np.array(options.least_color)
    return np.round(most * part + least * (1 - part)).astype(np.uint8)


def bounds_of(
    cloud: Cloud, options: ColorOptions, T_fixed_cloud: Matrix
) -> tuple[float, float] | None:
    """Return between which values a cloud has its colours; None where it has none."""
    transformer = transformer_of(cloud, options.transformer)
    if transformer == "AxisColor":
        values = _coordinates(cloud, options, T_fixed_cloud)
        return options.coordinates or _bounds(values)
    values = intensities_of(cloud, options.channel)
    if transformer != "Intensity" or values is None:
        return None
    return options.intensities or _bounds(values)


def _coordinates(cloud: Cloud, options: ColorOptions, T: Matrix) -> Floats:
    axis = max(_AXES.find(options.axis), 0)
    points = cloud.points.astype(np.float64)
    if options.in_fixed_frame:
        return points @ T[axis, :3] + T[axis, 3]
    return points[:, axis]


def _axis_color(cloud: Cloud, options: ColorOptions, T: Matrix) -> Colors:
    values = _coordinates(cloud, options, T)
    low, high = options.coordinates or _bounds(values)
    span = high - low
    return rainbow(1 - (values - low) / (span if span != 0 else _NO_SPAN))


def _bounds(values: Floats) -> tuple[float, float]:
    if not len(values):
        return 0.0, 0.0
    low, high = float(values.min()), float(values.max())
    # That of NaN is NaN.
    if not np.isfinite(high - low):
        return _bounds(values[np.isfinite(values)])
    return max(low, -_FARTHEST), min(high, _FARTHEST)


def _packed(cloud: Cloud) -> Values | None:
    """Return the colours in one number, 0xAARRGGBB, as they stand in the message."""
    for name in ("rgb", "rgba"):
        values = cloud.fields.get(name)
        if values is not None and _name(values) in ("int32", "uint32", "float32"):
            return values
    return None


def _rgb8(cloud: Cloud) -> Colors:
    values = _packed(cloud)
    if values is None:
        return np.array([WHITE], np.uint8)
    parts: Any = np.frombuffer(values.tobytes(), np.uint8)
    parts = parts.reshape(-1, 4)
    has_alpha = "rgb" not in cloud.fields
    return parts[:, [2, 1, 0, 3] if has_alpha else [2, 1, 0]]


def _rgbf32(cloud: Cloud) -> Colors:
    parts = np.stack([cloud.fields[name] for name in "rgb"], axis=1)
    return np.round(255 * _clipped(parts)).astype(np.uint8)


def _clipped(values: npt.NDArray[np.floating[Any]]) -> Floats:
    """Return values between 0 and 1; NaN becomes 0."""
    return np.fmin(np.fmax(values.astype(np.float64, copy=False), 0.0), 1.0)


def _is_float(values: Values | None) -> bool:
    return values is not None and _name(values) == "float32"


def _name(values: Values) -> str:
    kind: Any = values.dtype
    return str(kind.name)
