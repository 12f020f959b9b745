"""FluidPressure, Illuminance, RelativeHumidity and Temperature: one coloured point."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from sambot_viz.displays.data.cloud.cloud import Cloud
from sambot_viz.displays.data.cloud.cloud_display import CloudDisplay
from sambot_viz.displays.data.cloud.cloud_properties import CHANNEL, CLOUD_PROPERTIES
from sambot_viz.displays.data.message_numbers import require_finite
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.meanings import Meaning
from sambot_viz.rviz import Property


def measurement_properties(
    channel: str, least: float, most: float, *, is_inverted: bool = False
) -> tuple[Property, ...]:
    """Return the properties of points with the defaults of a measurement.

    Args:
        channel: the field that gives the colour.
        least: the value with the first colour.
        most: the value with the last colour.
        is_inverted: whether the rainbow begins with magenta.
    """
    defaults = {
        CHANNEL: channel,
        "Min Intensity": least,
        "Max Intensity": most,
        "Invert Rainbow": is_inverted,
        "Autocompute Intensity Bounds": False,
    }
    changed = (
        replace(one, default=defaults[one.name]) if one.name in defaults else one
        for one in CLOUD_PROPERTIES
    )
    return (topic_property(), *changed)


def point_with(field: str) -> Callable[[Any], Cloud]:
    """Return what reads a message as a point at its frame.

    Args:
        field: of the message, with the value that is measured.
    """

    def read(message: Any) -> Cloud:
        value = float(getattr(message, field))
        require_finite([value])
        return Cloud(np.zeros((1, 3), np.float32), {field: np.array([value])})

    return read


class FluidPressureDisplay(CloudDisplay):
    """The pressure of sensor_msgs/FluidPressure [Pa]."""

    kind = "rviz_default_plugins/FluidPressure"
    meanings = frozenset({Meaning.PRESSURE})
    points_of = point_with("fluid_pressure")
    properties = measurement_properties("fluid_pressure", 98000.0, 105000.0)


class IlluminanceDisplay(CloudDisplay):
    """The brightness of sensor_msgs/Illuminance [lx]."""

    kind = "rviz_default_plugins/Illuminance"
    meanings = frozenset({Meaning.LIGHT})
    points_of = point_with("illuminance")
    properties = measurement_properties("illuminance", 0.0, 1000.0)


class RelativeHumidityDisplay(CloudDisplay):
    """The humidity of sensor_msgs/RelativeHumidity, 0 to 1."""

    kind = "rviz_default_plugins/RelativeHumidity"
    meanings = frozenset({Meaning.HUMIDITY})
    points_of = point_with("relative_humidity")
    properties = measurement_properties("relative_humidity", 0.0, 1.0)


class TemperatureDisplay(CloudDisplay):
    """The temperature of sensor_msgs/Temperature [°C]."""

    kind = "rviz_default_plugins/Temperature"
    meanings = frozenset({Meaning.TEMPERATURE})
    points_of = point_with("temperature")
    properties = measurement_properties("temperature", 0.0, 100.0, is_inverted=True)
