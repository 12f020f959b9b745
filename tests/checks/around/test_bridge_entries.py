"""An entry of a bridge without its "- " is named at its line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.checks import check

Copied = Callable[[str], Path]
MODEL, BRIDGE = "urdf/cart.urdf.xacro", "config/bridge_config.yaml"


@pytest.mark.parametrize(
    ("blanks", "hint"),
    [
        ("  ", 'write "- " in place of the last 2 blanks before ros_topic_name'),
        ("", 'write - ros_topic_name: "{}"'),
    ],
)
@pytest.mark.parametrize("topic", ["/demo/imu", "/demo/odom", "/scan"])
def test_an_entry_without_its_dash_is_named(
    copied: Copied, topic: str, blanks: str, hint: str
) -> None:
    folder = copied("gz")
    bridge = folder / BRIDGE
    right = bridge.read_text()
    first = f'- ros_topic_name: "{topic}"'
    bridge.write_text(right.replace(first, blanks + first.removeprefix("- ")))
    line = right[: right.index(first)].count("\n") + 1

    problems = [p for p in check(folder / MODEL) if p.file == str(bridge)]

    assert [(p.code, p.line) for p in problems] == [("parameters-yaml", line)]
    assert problems[0].hint == hint.format(topic)
    bridge.write_text(right)
    assert check(folder / MODEL) == []
