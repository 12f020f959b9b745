"""Points get the colours that RViz gives them."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from sambot_viz.displays.data.cloud.cloud import (
    Cloud,
    cloud_of_cloud,
    cloud_of_cloud2,
)
from sambot_viz.displays.data.cloud.colors import (
    ColorOptions,
    colors_of,
    rainbow,
    transformer_of,
)
from sambot_viz.displays.data.refused_messages import MessageRefused

F = np.float32


def cloud(
    points: object = ((0, 0, 0), (0, 0, 1), (0, 0, 2)), **fields: object
) -> Cloud:
    arrays = {name: np.asarray(values) for name, values in fields.items()}
    return Cloud(np.array(points, F), arrays)


def colors(of: Cloud, **options: object) -> list[list[int]]:
    made = colors_of(of, ColorOptions(**options), np.eye(4))  # type: ignore[arg-type]
    return np.broadcast_to(made, (len(of.points), made.shape[1])).tolist()


THREE = [[255, 0, 0], [0, 255, 128], [255, 0, 255]]


def test_the_rainbow_goes_from_magenta_to_red() -> None:
    steps = rainbow(np.array([-1, 0, 0.2, 0.4, 0.6, 0.8, 1, 2, np.nan]))
    magenta, red = [255, 0, 255], [255, 0, 0]
    blue, cyan, green, yellow = [0, 0, 255], [0, 255, 255], [0, 255, 0], [255, 255, 0]
    between = [magenta, blue, cyan, green, yellow, red]
    assert steps.tolist() == [magenta, *between, red, magenta]


def test_the_least_intensity_is_red_unless_it_is_inverted() -> None:
    three = cloud(intensity=F([0, 1, 2]))
    assert colors(three) == THREE
    assert colors(three, is_inverted=True) == THREE[::-1]
    black_to_red = {"is_rainbow": False, "most_color": (255, 0, 0)}
    assert colors(three, **black_to_red) == [[0, 0, 0], [128, 0, 0], [255, 0, 0]]


def test_bounds_that_are_set_hold_instead_of_those_of_the_message() -> None:
    three = cloud(intensity=F([0, 1024, 2048]))
    found = colors(three, intensities=(0.0, 4096.0))
    assert found == [[255, 0, 0], [191, 255, 0], [0, 255, 128]]


def test_equal_intensities_are_red_and_none_are_white() -> None:
    assert colors(cloud(intensity=F([7, 7, 7]))) == [[255, 0, 0]] * 3
    assert colors(cloud()) == [[255, 255, 255]] * 3
    assert colors(cloud(intensities=F([0, 1, 2]))) == THREE


def test_whole_numbers_are_read_without_a_sign() -> None:
    found = colors(cloud(ring=np.array([0, -1, 1], np.int8)), channel="ring")
    assert found[0] == [255, 0, 0]
    assert found[1] == [255, 0, 255]


def test_a_coordinate_colours_in_the_fixed_frame_or_in_that_of_the_points() -> None:
    three = cloud()
    assert colors(three, transformer="AxisColor") == THREE
    bounds = colors(three, transformer="AxisColor", coordinates=(-10.0, 10.0))
    assert bounds == [[0, 255, 128], [0, 255, 191], [0, 255, 255]]
    turned = np.diag([1.0, -1.0, -1.0, 1.0])
    options = ColorOptions(transformer="AxisColor")
    assert colors_of(three, options, turned).tolist() == THREE[::-1]
    own = ColorOptions(transformer="AxisColor", in_fixed_frame=False)
    assert colors_of(three, own, turned).tolist() == THREE


def test_packed_colours_come_with_their_alpha_where_they_have_one() -> None:
    packed = np.array([0x80FF0000, 0x0000FF00, 0xFF0000FF], np.uint32)
    assert colors(cloud(rgb=packed.view(F))) == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]
    alphas = [color[3] for color in colors(cloud(rgba=packed))]
    assert alphas == [0x80, 0, 0xFF]


@pytest.mark.parametrize(
    ("fields", "wanted", "chosen"),
    [
        ({}, "", "Intensity"),
        ({"rgb": F([0, 0, 0])}, "", "RGB8"),
        ({"rgb": F([0, 0, 0])}, "FlatColor", "FlatColor"),
        ({}, "RGB8", "Intensity"),
        ({"r": F([0, 0, 0]), "g": F([0, 0, 0]), "b": F([0, 0, 0])}, "RGBF32", "RGBF32"),
    ],
)
def test_a_transformer_without_its_fields_is_replaced(
    fields: dict[str, object], wanted: str, chosen: str
) -> None:
    assert transformer_of(cloud(**fields), wanted) == chosen


def cloud2(rows: np.ndarray, count: int | None = None) -> SimpleNamespace:
    kinds = {"f4": 7, "u1": 2, "f8": 8, "i2": 3}
    fields = [
        SimpleNamespace(
            name=name,
            offset=rows.dtype.fields[name][1],
            datatype=kinds[rows.dtype[name].str[1:]],
            count=1,
        )
        for name in rows.dtype.names
    ]
    return SimpleNamespace(
        width=len(rows) if count is None else count,
        height=1,
        point_step=rows.dtype.itemsize,
        row_step=rows.dtype.itemsize * (len(rows) if count is None else count),
        is_bigendian=rows.dtype[0].str[0] == ">",
        fields=fields,
        data=np.frombuffer(rows.tobytes(), np.uint8),
    )


XYZ = [("x", "f4"), ("y", "f4"), ("z", "f4")]


def test_points_that_are_nowhere_are_dropped_with_their_fields() -> None:
    rows = np.zeros(4, [*XYZ, ("pad", "f4"), ("ring", "u1")])
    rows["x"] = [0, np.nan, 2, np.inf]
    rows["ring"] = [1, 2, 3, 4]
    found = cloud_of_cloud2(cloud2(rows))
    assert found.points[:, 0].tolist() == [0, 2]
    assert found.fields["ring"].tolist() == [1, 3]


def test_a_cloud_of_the_other_byte_order_is_read_in_it() -> None:
    """RViz reads all as little endian: its points are at 0, with wrong intensities."""
    row = [("x", ">f4"), ("y", ">f4"), ("z", ">f4"), ("ring", ">i2"), ("t", ">f8")]
    cloud = cloud_of_cloud2(cloud2(np.array([(1, 2, 3, 4, 5), (6, 7, 8, 9, 10)], row)))
    assert cloud.points.tolist() == [[1, 2, 3], [6, 7, 8]]
    assert cloud.fields["ring"].tolist() == [4, 9]
    assert cloud.fields["t"].tolist() == [5, 10]


def test_a_cloud_that_says_another_size_is_refused_whatever_it_says() -> None:
    rows = np.zeros(2, XYZ)
    for count in (0, 1, 3, 10**9, 2**32 - 1):
        with pytest.raises(MessageRefused, match="does not match width"):
            cloud_of_cloud2(cloud2(rows, count))


def test_only_32_bit_floats_are_places() -> None:
    rows = np.zeros(2, [("x", "f8"), ("y", "f8"), ("z", "f8")])
    with pytest.raises(MessageRefused, match="No position transformer"):
        cloud_of_cloud2(cloud2(rows))


def test_the_older_clouds_have_a_field_for_each_channel() -> None:
    points = [SimpleNamespace(x=1.0, y=2.0, z=3.0), SimpleNamespace(x=0, y=0, z=0)]
    channel = SimpleNamespace(name="intensity", values=F([5, 6]))
    found = cloud_of_cloud(SimpleNamespace(points=points, channels=[channel]))
    assert found.points.tolist() == [[1, 2, 3], [0, 0, 0]]
    assert found.fields["intensity"].tolist() == [5, 6]
    channel.values = F([5])
    with pytest.raises(MessageRefused, match="1 values for 2 points"):
        cloud_of_cloud(SimpleNamespace(points=points, channels=[channel]))


CLOUDS = Path(__file__).parents[2] / "golden" / "messages"


def test_the_recorded_probes_agree_with_the_formula() -> None:
    """RViz's own pixels: of a scan of 19 readings with the intensities 0, 10, …."""
    probes = json.loads((CLOUDS / "scan_points_rainbow" / "values.json").read_text())
    wanted = [probe["render_rgb"] for probe in probes["probes"]]
    found = rainbow(1 - np.arange(len(wanted)) / (len(wanted) - 1))
    assert np.abs(found.astype(int) - np.array(wanted)).max() <= 1
