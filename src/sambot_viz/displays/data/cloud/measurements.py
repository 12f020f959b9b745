"""FluidPressure, Illuminance, RelativeHumidity and Temperature: one coloured point."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from sambot_viz.displays.data.cloud.cloud import Cloud
from sambot_viz.displays.data.cloud.cloud_display import CloudDisplay
from sambot_viz.displays.data.cloud.cloud_properties import CHANNEL, CLOUD_PROPERTIES
from sambot_viz.displays.data.message_numbers import require_finite
from sambot_viz.displays.data.topic_display import topic_property
from sambot_viz.frames import Transform
from sambot_viz.geometry import Matrix
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


class MeasurementDisplay(CloudDisplay):
    """Draws what a sensor measures as a point at its frame."""

    field: ClassVar[str]
    """The field of the message with the value."""

    def cloud_of(self, message: Any, T_fixed_frame: Transform) -> tuple[Cloud, Matrix]:
        """Return a point at the origin of the frame."""
        value = float(getattr(message, self.field))
        require_finite([value])
        fields = {self.field: np.array([value])}
        return Cloud(np.zeros((1, 3), np.float32), fields), T_fixed_frame.matrix


class FluidPressureDisplay(MeasurementDisplay):
    """The pressure of sensor_msgs/FluidPressure [Pa]."""

    kind = "rviz_default_plugins/FluidPressure"
    help = "Pressures as coloured points."
    meanings = frozenset({Meaning.PRESSURE})
    field = "fluid_pressure"
    properties = measurement_properties(field, 98000.0, 105000.0)


class IlluminanceDisplay(MeasurementDisplay):
    """The brightness of sensor_msgs/Illuminance [lx]."""

    kind = "rviz_default_plugins/Illuminance"
    help = "Brightnesses as coloured points."
    meanings = frozenset({Meaning.LIGHT})
    field = "illuminance"
    properties = measurement_properties(field, 0.0, 1000.0)


class RelativeHumidityDisplay(MeasurementDisplay):
    """The humidity of sensor_msgs/RelativeHumidity, 0 to 1."""

    kind = "rviz_default_plugins/RelativeHumidity"
    help = "Humidities as coloured points."
    meanings = frozenset({Meaning.HUMIDITY})
    field = "relative_humidity"
    properties = measurement_properties(field, 0.0, 1.0)


class TemperatureDisplay(MeasurementDisplay):
    """The temperature of sensor_msgs/Temperature [°C]."""

    kind = "rviz_default_plugins/Temperature"
    help = "Temperatures as coloured points."
    meanings = frozenset({Meaning.TEMPERATURE})
    field = "temperature"
    properties = measurement_properties(field, 0.0, 100.0, is_inverted=True)
