"""Read SDF files and compare with what sdformat_urdf made of them.

The probes and the robots in `ours` are part of these tests; models of other people are
read where they are.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from expected_robot import assert_as_expected
from quick_yaml import quick_yaml

from sambot_viz import RobotError, load_robot

DATA = Path(__file__).parents[2] / "data" / "sdf"
SHARED = Path(__file__).parents[4] / "shared" / "data" / "sdf"

DIFFERENT = {
    "ver_112": "newer releases of ROS read version 1.12, and so do we",
    "xml_amp": "xacro, which every launch file runs first, refuses a bare &",
}
"""Probes that Jazzy alone, or a file that does not go through xacro, answers else."""


def _entries(file: Path) -> list[dict[str, Any]]:
    return quick_yaml(file) if file.is_file() else []


def _of(file: Path, *, ours: bool = False) -> list[Any]:
    return [
        pytest.param(entry, id=entry["id"])
        for entry in _entries(file)
        if entry["file"].startswith("ours/") == ours
    ]


@pytest.mark.parametrize(
    "probe",
    [
        pytest.param(entry, id=entry["id"])
        for entry in _entries(DATA / "probes.yaml")
        if entry["id"] not in DIFFERENT
    ],
)
def test_small_texts_are_read_as_ros_reads_them(probe: dict[str, Any]) -> None:
    _compare(probe["sdf"].strip() or "<", probe)


def test_the_two_different_answers_are_the_ones_that_are_meant() -> None:
    probes = {entry["id"]: entry for entry in _entries(DATA / "probes.yaml")}
    assert load_robot(probes["ver_112"]["sdf"]).root == "a"
    with pytest.raises(RobotError, match="xml-ampersand"):
        load_robot(probes["xml_amp"]["sdf"])


@pytest.mark.parametrize("entry", _of(DATA / "expected.yaml", ours=True))
def test_our_robots_are_as_in_ros(entry: dict[str, Any]) -> None:
    _compare(DATA / entry["file"], entry)


@pytest.mark.skipif(not SHARED.is_dir(), reason="needs ../shared/data/sdf")
@pytest.mark.parametrize(
    "entry",
    [
        *_of(SHARED / "expected.yaml"),
        *_of(SHARED / "ros" / "expected.yaml"),
        *_of(SHARED / "gazebosim" / "expected.yaml"),
    ],
)
def test_models_of_others_are_as_in_ros(entry: dict[str, Any]) -> None:
    _compare(SHARED / entry["file"], entry)


def _compare(model: Path | str, expected: dict[str, Any]) -> None:
    if expected["ros"] == "accepted":
        assert_as_expected(load_robot(model), expected)
        return
    with pytest.raises(RobotError) as refused:
        load_robot(model)
    errors = [p for p in refused.value.problems if p.severity == "error"]
    assert errors
    assert all(problem.hint for problem in errors)
