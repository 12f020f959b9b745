"""A footprint that Nav2 cannot read is found, and the advice mends it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

MODEL = "urdf/cart.urdf.xacro"
NAV2 = "config/nav2_params.yaml"
CORNERS = "[ [0.21, 0.195], [0.21, -0.195], [-0.21, -0.195], [-0.21, 0.195] ]"

Copied = Callable[[str], Path]


@pytest.mark.parametrize(
    ("severity", "wrong", "cause"),
    [
        ("error", f"footprint: {CORNERS}", "is a list"),
        ("warning", f'footprint: "{CORNERS[:-3]} ]"', "a ] is missing"),
        ("warning", f'footprint: "{CORNERS[1:]}"', "a [ is missing"),
        (
            "warning",
            'footprint: "0.21, 0.195, 0.21, -0.195, -0.21, -0.195, -0.21, 0.195"',
            "the corners have no brackets",
        ),
        (
            "warning",
            f'footprint: "{CORNERS}"'.replace("0.21, 0.195]", "abc, 0.195]", 1),
            "abc is not a number",
        ),
    ],
)
def test_a_footprint_that_nav2_cannot_read(
    copied: Copied, severity: str, wrong: str, cause: str
) -> None:
    package = copied("gz")
    nav2 = package / NAV2
    text = nav2.read_text()
    right = f'footprint: "{CORNERS}"'
    assert right in text
    nav2.write_text(text.replace(right, wrong))

    (problem,) = check(package / MODEL)

    assert (problem.code, problem.severity) == ("footprint-text", severity)
    assert (problem.file, problem.line) == (str(nav2), 22)
    assert cause in problem.message
    if "abc" in wrong:
        assert problem.hint == "write a length in metres in place of abc"
        better = wrong.replace("abc", "0.21")
    else:
        better = "footprint: " + problem.hint.removeprefix("write ")
    nav2.write_text(text.replace(right, better))
    assert check(package / MODEL) == []


@pytest.mark.parametrize(
    "other",
    [
        f"footprint: '{CORNERS}'",
        f'footprint: "{CORNERS[:-2]}, ]"',
        f'footprint: "{CORNERS}"\n      footprint_padding: 0.01',
        'footprint: "[]"',
        "footprint: <footprint>",
        "footprint_topic: somewhere",
    ],
)
def test_what_nav2_reads_is_not_reported(copied: Copied, other: str) -> None:
    package = copied("gz")
    nav2 = package / NAV2
    nav2.write_text(nav2.read_text().replace(f'footprint: "{CORNERS}"', other))
    assert check(package / MODEL) == []
