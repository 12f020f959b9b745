"""A guess from numbers is a note from one clue, and a warning from two."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check
from sambot_viz.checks.clues import is_written_whole, severity

Told = Callable[[str], list[tuple[str, str]]]

GUESSES = frozenset(
    """
    shape-size mass-in-grams wheel-across-axle wheels-in-one-place limit-in-degrees
    rpy-in-degrees mesh-size falls-over wheel-not-on-ground footprint-size
    drive-wheel-separation drive-wheel-radius
    """.split()
)
INERTIA = '<inertia ixx="{0}" iyy="{0}" izz="{0}" ixy="0" ixz="0" iyz="0"/>'
JOINT = '<joint name="j" type="{}"><parent link="a"/><child link="b"/>{}</joint>'
LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'


@pytest.fixture
def told(tmp_path: Path) -> Told:
    """Returns code and severity of the guesses about a robot."""

    def run(body: str) -> list[tuple[str, str]]:
        file = tmp_path / "r.urdf"
        file.write_text(f'<robot name="r">{body}</robot>')
        return [(p.code, p.severity) for p in check(file) if p.code in GUESSES]

    return run


def link(name: str, geometry: str, mass: float = 0, inertia: float = 1) -> str:
    weight = f'<inertial><mass value="{mass}"/>{INERTIA.format(inertia)}</inertial>'
    return (
        f'<link name="{name}"><visual><geometry>{geometry}</geometry></visual>'
        f"{weight if mass else ''}</link>"
    )


def test_a_guess_is_never_an_error() -> None:
    assert [severity(set("abc"[:count])) for count in range(4)] == [
        "info",
        "info",
        "warning",
        "warning",
    ]


@pytest.mark.parametrize(
    ("value", "whole"),
    [(420, True), (15, True), (100, False), (1, False), (0, False), (1.5, False)],
)
def test_what_people_write_for_the_unknown_is_no_measured_number(
    value: float, whole: bool
) -> None:
    assert is_written_whole(value) is whole


@pytest.mark.parametrize(
    ("body", "said"),
    [
        # A floor neither moves nor weighs.
        (link("a", '<box size="200 200 10"/>'), "info"),
        (link("a", '<box size="200 200 10"/>', 2), "warning"),
        (
            link("a", '<box size="200 200 10"/>')
            + '<link name="b"/>'
            + JOINT.format("continuous", ""),
            "warning",
        ),
    ],
)
def test_a_house_is_a_robot_where_it_moves_or_is_too_light(
    told: Told, body: str, said: str
) -> None:
    assert told(body) == [("shape-size", said)]


RAIL = (
    link("world", '<box size="0.3 0.2 0.1"/>')
    + link("a", '<box size="{0} 0.05 0.05"/>')
    + link("b", '<box size="0.5 0.5 0.2"/>')
    + link("c", '<box size="0.4 0.5 0.2"/>')
    + '<joint name="f" type="fixed"><parent link="world"/><child link="a"/></joint>'
    + '<joint name="g" type="fixed"><parent link="b"/><child link="c"/></joint>'
    + JOINT.format("prismatic", LIMIT.format("-{1}", "{1}"))
)


@pytest.mark.parametrize(
    ("length", "travel", "said"),
    [
        (30, 15, []),
        (30, 12, []),
        (30, 0.2, [("shape-size", "warning")]),
        (10, 0.2, [("shape-size", "info")]),
        (3.4, 0.2, [("shape-size", "info")]),
        # In centimetres it is as long as another part.
        (40, 0.2, [("shape-size", "warning")]),
        (4.5, 0.2, [("shape-size", "info")]),
    ],
)
def test_a_rail_is_as_long_as_what_slides_on_it(
    told: Told, length: float, travel: float, said: list[tuple[str, str]]
) -> None:
    assert told(RAIL.format(length, travel)) == said


@pytest.mark.parametrize(
    ("box", "mass", "inertia", "said"),
    [
        ("0.05 0.05 0.05", 125, 1, ["warning"]),
        # Placeholders have any mass and any shape.
        ("0.01 0.01 0.01", 10, 1, ["info"]),
        ("0.01 0.01 0.01", 1.5, 1, ["info"]),
        ("0.03 0.03 0.03", 10, 1, ["info"]),
        # The inertia is that of ten grams.
        ("0.03 0.03 0.03", 10, 1e-6, ["warning"]),
    ],
)
def test_a_placeholder_of_a_mass_is_not_in_grams(
    told: Told, box: str, mass: float, inertia: float, said: list[str]
) -> None:
    body = link("a", '<box size="0.2 0.2 0.2"/>', 0.4)
    body += link("b", f'<box size="{box}"/>', mass, inertia)
    found = told(body + JOINT.format("fixed", ""))
    assert found == [("mass-in-grams", each) for each in said]


@pytest.mark.parametrize(
    ("upper", "said"),
    [("90", "warning"), ("22.5", "warning"), ("100", "info"), ("50", "info")],
)
def test_a_limit_is_in_degrees_where_it_is_a_usual_angle(
    told: Told, upper: str, said: str
) -> None:
    parts = '<link name="a"/><link name="b"/>'
    joint = JOINT.format("revolute", LIMIT.format(f"-{upper}", upper))
    assert told(parts + joint) == [("limit-in-degrees", said)]
    other = joint.replace(f'-{upper}"', '-1.57"').replace(f'"{upper}"', '"1.57"')
    other = other.replace('"j"', '"i"').replace('"b"', '"c"')
    both = f'{parts}<link name="c"/>{joint}{other}'
    assert told(both) == [("limit-in-degrees", "warning")]


@pytest.mark.parametrize(("rpy", "said"), [("0 0 90", "warning"), ("0 0 10", "info")])
def test_an_angle_is_in_degrees_where_it_is_a_usual_one(
    told: Told, rpy: str, said: str
) -> None:
    joint = JOINT.format("fixed", f'<origin rpy="{rpy}"/>')
    body = f'<link name="a"/><link name="b"/>{joint}'
    assert told(body) == [("rpy-in-degrees", said)]


DISC = (
    '<link name="{name}"><visual><geometry><cylinder radius="0.1" length="0.02"/>'
    '</geometry></visual></link><joint name="{name}_joint" type="continuous">'
    '<parent link="base_link"/><child link="{name}"/><origin xyz="{at}"/>'
    '<axis xyz="0 1 0"/></joint>'
)
BASE = link("base_link", '<box size="0.3 0.2 0.1"/>')


@pytest.mark.parametrize(
    ("name", "at", "said"),
    [
        ("disc", "0 0 1", ["info"]),
        ("wheel", "0 0 1", ["warning"]),
        ("disc", "0 0 -0.1", ["warning"]),
        ("propeller_1", "0 0 -0.1", []),
        ("tail_rotor", "0 0 1", []),
        ("front_fan", "0 0 1", []),
    ],
)
def test_a_disc_is_a_wheel_by_its_name_or_on_the_ground_and_never_a_propeller(
    told: Told, name: str, at: str, said: list[str]
) -> None:
    body = BASE + DISC.format(name=name, at=at)
    assert told(body) == [("wheel-across-axle", each) for each in said]


@pytest.mark.parametrize(
    ("one", "other", "said"),
    [
        ("disc", "plate", ["info"]),
        ("left_disc", "right_disc", ["warning"]),
        ("front_wheel", "back_wheel", ["warning"]),
        ("upper_propeller", "lower_propeller", []),
    ],
)
def test_propellers_may_be_in_one_place(
    told: Told, one: str, other: str, said: list[str]
) -> None:
    discs = (DISC.format(name=name, at="0 0.2 1") for name in (one, other))
    laid = "".join(discs).replace("<visual>", '<visual><origin rpy="1.5708 0 0"/>')
    assert told(BASE + laid) == [("wheels-in-one-place", each) for each in said]


@pytest.mark.parametrize(
    ("name", "said"), [("disc", ["info"]), ("wheel", ["warning"]), ("propeller", [])]
)
def test_a_propeller_need_not_touch_the_ground(
    told: Told, name: str, said: list[str]
) -> None:
    disc = DISC.format(name=name, at="0 0 1")
    disc = disc.replace("<visual>", '<visual><origin rpy="1.5708 0 0"/>')
    foot = JOINT.replace('"a"', '"base_link"').replace('"b"', '"base_footprint"')
    body = f'{BASE}<link name="base_footprint"/>{foot.format("fixed", "")}{disc}'
    assert told(body) == [("wheel-not-on-ground", each) for each in said]
