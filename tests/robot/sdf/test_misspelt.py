"""A misspelt name in an SDF file is reported first, with the right word, and alone."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import load_robot

GOOD = """<sdf version="1.8">
  <model name="r">
    <link name="base">
      <visual name="shell">
        <pose>0 0 0.1 0 0 0</pose>
        <geometry>
          <box>
            <size>1 1 1</size>
          </box>
        </geometry>
        <material>
          <diffuse>1 0 0 1</diffuse>
        </material>
      </visual>
    </link>
    <link name="arm">
      <pose>0 0 1 0 0 0</pose>
      <inertial>
        <mass>1</mass>
      </inertial>
    </link>
    <joint name="shoulder" type="revolute">
      <parent>base</parent>
      <child>arm</child>
      <axis>
        <xyz>0 1 0</xyz>
        <limit>
          <lower>-1</lower>
          <upper>1</upper>
        </limit>
      </axis>
    </joint>
  </model>
</sdf>
"""


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


def slips(name: str) -> Iterator[str]:
    middle = len(name) // 2
    yield name[: middle - 1] + name[middle] + name[middle - 1] + name[middle + 1 :]
    yield name[:middle] + name[middle + 1 :]
    yield name.capitalize()


def test_every_misspelt_element_is_named_alone_with_the_right_word() -> None:
    wrong: list[object] = []
    assert found(GOOD) == ()
    for tag in re.finditer(r"<(\w+)[^<>]*>", GOOD):
        if tag[1] in ("sdf", "model"):
            continue
        line = GOOD.count("\n", 0, tag.start()) + 1
        end = GOOD.index(f"</{tag[1]}>", tag.start())
        for slip in set(slips(tag[1])) - {tag[1]}:
            text = f"{GOOD[: tag.start(1)]}{slip}{GOOD[tag.end(1) : end]}</{slip}>"
            problems = found(text + GOOD[end + len(tag[1]) + 3 :])
            only = [(p.line, p.code) for p in problems]
            right = problems and re.match(f"write <{tag[1]}[ >]", problems[0].hint)
            if only != [(line, "element-misspelt")] or not right:
                wrong.append((slip, line, problems))
    assert wrong == []


@pytest.mark.parametrize(
    ("wrong", "hint"),
    [
        ('nmae="shoulder" type="revolute"', 'write name="shoulder"'),
        ('name="shoulder" tpye="revolute"', 'write type="revolute"'),
    ],
)
def test_a_misspelt_attribute_is_named_with_the_right_word(
    wrong: str, hint: str
) -> None:
    problems = found(GOOD.replace('name="shoulder" type="revolute"', wrong))

    assert (problems[0].severity, problems[0].code) == ("error", "attribute-misspelt")
    assert problems[0].hint == hint
    assert len(problems) == 1


def test_a_misspelt_model_is_named() -> None:
    problems = found(GOOD.replace("model", "modle"))

    assert "did you mean <model>?" in problems[0].message
