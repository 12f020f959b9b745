"""An entry of a bridge without its "- ", and one for what nobody sends."""

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


SENDER = """    <plugin filename="gz-sim-joint-state-publisher-system"
            name="gz::sim::systems::JointStatePublisher">
      <topic>joint_states</topic>
    </plugin>
"""


def test_joint_states_that_no_plugin_sends(copied: Copied) -> None:
    folder = copied("gz")
    model = folder / MODEL
    right = model.read_text()
    assert SENDER in right
    model.write_text(right.replace(SENDER, ""))

    (problem,) = check(model)

    assert problem.file == str(folder / BRIDGE)
    assert "the bridge carries /joint_states, but no plugin" in problem.message
    plugin = problem.hint.removeprefix("add ").removesuffix(" beside that of the drive")
    model.write_text(right.replace(SENDER, plugin))
    assert check(model) == []


def test_joint_states_that_are_sent_to_a_topic_of_gazebo(copied: Copied) -> None:
    model = copied("gz") / MODEL
    right, topic = model.read_text(), "<topic>joint_states</topic>"
    model.write_text(right.replace(topic, ""))

    (problem,) = check(model)

    assert problem.file == str(model)
    assert "has no <topic>" in problem.message
    assert problem.hint == f"add {topic} to the plugin"


@pytest.mark.parametrize("key", ["gz_topic", "gz_topc_name"])
def test_a_misspelt_key_is_read_as_it_is_meant(copied: Copied, key: str) -> None:
    folder = copied("gz")
    bridge = folder / BRIDGE
    right = bridge.read_text()
    assert "gz_topic_name" in right
    bridge.write_text(right.replace("gz_topic_name", key, 1))

    (problem,) = check(folder / MODEL)

    assert (problem.code, problem.hint) == ("bridge-entry", "write gz_topic_name")
