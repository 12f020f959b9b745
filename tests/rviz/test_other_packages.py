"""Displays of other packages are named, with what they would need."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz.errors import SambotVizError
from sambot_viz.inputs import load_config
from sambot_viz.rviz.other_packages import OTHERS, about_other, package_of
from sambot_viz.rviz.support_report import ItemReport, config_report

COLLECTION = Path(__file__).parents[3] / "shared" / "data" / "rviz"


def test_a_known_display_says_what_it_is_of_whom_and_from_what() -> None:
    assert about_other("moveit_rviz_plugin/Trajectory") == (
        "The motion that MoveIt has planned. A display of moveit_ros_visualization, "
        "not of RViz itself: it would have to be drawn here from "
        "moveit_msgs/DisplayTrajectory."
    )
    # Older files have the C++ name.
    assert about_other("rviz_plugins::PoseHistory").startswith("Where a pose was")


def test_an_unknown_one_says_of_whom_it_is() -> None:
    about = "A display of my_radar, not of RViz itself, which is not known here."
    assert about_other("my_radar/Radar") == about
    assert "\x1b" not in about_other("a\x1b[31m/Radar")


@pytest.mark.parametrize(
    "kind", ["rviz_default_plugins/Camera", "rviz/Other", "Other", "", "a/", "/a"]
)
def test_of_other_classes_nothing_is_said(kind: str) -> None:
    assert about_other(kind) == package_of(kind) == ""


def items_of(file: Path) -> list[ItemReport]:
    try:
        report = config_report(load_config(str(file)))
    except SambotVizError:
        return []
    return [item for display in report.displays for item in display.walk()]


@pytest.mark.skipif(not COLLECTION.is_dir(), reason="../shared is not here")
def test_files_of_other_people_are_shown_whole_or_say_what_is_missing() -> None:
    files = [items_of(file) for file in sorted(COLLECTION.iterdir())]
    lacking = [
        {one.class_id for one in items if one.level == "not supported"}
        for items in files
    ]
    whole = [items for items, lack in zip(files, lacking, strict=True) if not lack]
    # Two of the files have no displays, and one is of an RViz before 2012.
    assert len([items for items in whole if items]) >= 135
    foreign = {kind for lack in lacking for kind in lack if package_of(kind)}
    assert foreign
    known = {kind for kind in foreign if kind.replace("::", "/") in OTHERS}
    # Most are known by their names, and each of the others by its package.
    assert len(known) > 0.75 * len(foreign)
    assert all(about_other(kind) for kind in foreign)
