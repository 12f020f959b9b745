"""What statuses say, word for word beside what was read out of the real RViz.

Where RViz 2 says something else than RViz 1.14, which was recorded, its words hold.
Each difference has its reason in `differences.yaml`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from quick_yaml import quick_yaml
from situations import display_of, frame_of
from status_world import Rows, World, statuses_in

HERE = Path(__file__).parent
RECORDED: Mapping[str, Any] = quick_yaml(HERE / "statuses.yaml")
DIFFERENCES = quick_yaml(HERE / "differences.yaml")
GROUPS: Mapping[str, tuple[str, Mapping[str, Any]]] = {
    "once": ("each_message_sent_once", {}),
    "often": ("sent_at_5_hz_for_6_s", {"count": 12}),
    "nowhere": ("fixed_frame_nowhere_sent_once", {"fixed_frame": "nowhere"}),
    "no_tf": ("no_tf_at_all_sent_once", {"has_tf": False}),
}
"""Short name → the name in the file, and what is other than once with transforms."""
ALIKE = {
    "AccelStamped": "Wrench",
    "FluidPressure": "LaserScan",
    "Illuminance": "LaserScan",
    "PointCloud": "LaserScan",
    "RelativeHumidity": "LaserScan",
    "Temperature": "LaserScan",
    "TwistStamped": "Wrench",
}
"""Display that was not recorded → one that says the same of what `OF_ALIKE` lists."""
OF_ALIKE = ("none", "ok", "badframe", "emptyframe")
WITHOUT_MESSAGE = ("none", "emptytopic", "wrongtype")


def _situations(group: str) -> dict[str, list[list[str]]]:
    """Return situation → rows, with those of displays that are like others."""
    found = dict(RECORDED[GROUPS[group][0]])
    for display, other in ALIKE.items():
        for what in OF_ALIKE:
            rows = found.get(f"{what}.{other}")
            if rows is not None:
                found[f"{what}.{display}"] = rows
    return found


ALL = [f"{group}:{name}" for group in GROUPS for name in _situations(group)]


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Rows]:
    """Group and situation → the rows that its display has."""
    found: dict[str, Rows] = {}
    for group, (_, values) in GROUPS.items():
        names = list(_situations(group))
        # A robot brings frames, so it is shown without the others.
        robots = [name for name in names if display_of(name) == "RobotModel"]
        others = [name for name in names if name not in robots]
        for part in filter(None, (robots, others)):
            rows = statuses_in(World(part, **values), tmp_path_factory.mktemp(group))
            found |= {f"{group}:{name}": rows[name] for name in rows}
    return found


def recorded(situation: str) -> Rows:
    """Return recorded rows as RViz 2 has them where it only words them in another way.

    RViz counts the messages that have a place; here all that have come are counted.
    """
    group, _, name = situation.partition(":")
    what, display = name.partition(".")[0], display_of(name)
    found: Rows = {}
    for level, key, text in _situations(group)[name]:
        if key == "Topic" and level == "Ok" and what not in WITHOUT_MESSAGE:
            text = "N messages received at F hz."
        elif key == "Points":
            text = "Showing [N] points from [N] messages"
        elif display == "TF":
            text = text.replace("to frame [", "to [")
        elif key == "Transform":
            text = re.sub(r"For frame \[\w*\]: (No transform)", r"\1", text)
            text = text.replace("].  TF", "]. TF")
            text = re.sub(r"extrapolation [\d.]+s into", "extrapolation into", text)
            text = re.sub(r"\d{10}\.\d+", "T", text)
        found[key] = (level, text)
    return found


def _differences(situation: str) -> list[int]:
    return [
        number
        for number, one in enumerate(DIFFERENCES)
        if _fits(situation, one["where"]) and not _fits(situation, one.get("but", ()))
    ]


def _fits(situation: str, patterns: Sequence[str]) -> bool:
    return any(fnmatchcase(situation, pattern) for pattern in patterns)


@cache
def _place(situation: str) -> dict[str, str]:
    group, _, name = situation.partition(":")
    display = display_of(name)
    frame = frame_of(name.partition(".")[0], display)
    return {"frame": frame, "fixed": GROUPS[group][1].get("fixed_frame", "map")}


def expected(situation: str) -> Rows:
    """Return what a display says in a situation."""
    rows = recorded(situation)
    for number in _differences(situation):
        for key, row in DIFFERENCES[number]["rows"].items():
            if row is None:
                rows.pop(key, None)
            else:
                rows[key] = (row[0], row[1].format_map(_place(situation)))
    return rows


def without_numbers(rows: Rows) -> Rows:
    """Return rows with words in place of times, rates, topics and counts of points."""
    found: Rows = {}
    for key, (level, text) in rows.items():
        text = re.sub(r"^\d+ (messages received at )\d+\.\d hz", r"N \1F hz", text)
        text = re.sub(r"\d{10}\.\d{6}", "T", text)
        text = re.sub(r"topic (info -v )?/\w+/\w+", r"topic \1TOPIC", text)
        text = re.sub(r"(known: |did you mean ).*", "KNOWN", text)
        if key == "Points":
            text = re.sub(r"\d+", "N", text)
        # The remedy follows RViz's sentence.
        text = re.sub(r"(does not exist|\])\. (?!TF error).*", r"\1", text)
        found[key] = (level, text)
    return found


@pytest.mark.parametrize("situation", ALL)
def test_a_status_says_what_rviz_says(
    situation: str, shown: Mapping[str, Rows]
) -> None:
    assert without_numbers(shown[situation]) == expected(situation)


@pytest.mark.parametrize(
    ("group", "row"),
    [
        ("once", ("Ok", "OK")),
        ("nowhere", ("Error", "Frame [nowhere] does not exist")),
        ("no_tf", ("Warn", "No tf data.  Actual error: Frame [map] does not exist")),
    ],
)
def test_the_fixed_frame_has_the_words_of_rviz_2(
    group: str, row: tuple[str, str], shown: Mapping[str, Rows]
) -> None:
    levels = {level for level, _, _ in RECORDED["global"].values()}
    assert row[0] in levels
    assert shown[f"{group}:"] == {"Fixed Frame": row}


def test_each_difference_is_one() -> None:
    used: set[int] = set()
    for situation in ALL:
        if recorded(situation) != expected(situation):
            used.update(_differences(situation))
    assert used == set(range(len(DIFFERENCES)))
