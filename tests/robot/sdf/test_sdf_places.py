"""What is at a wrong place in an SDF file is answered with where it belongs.

What each problem says is done to the text, and then nothing is left to say.
"""

from __future__ import annotations

import re

import pytest

from sambot_viz import Problem, RobotError, load_robot

GOOD = """<sdf version="1.8">
<model name="bot">
<link name="base">
<inertial>
<mass>2</mass>
<inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>
</inertial>
<visual name="shell">
<geometry>
<cylinder>
<radius>0.1</radius>
<length>0.06</length>
</cylinder>
</geometry>
<material>
<ambient>1 0 0 1</ambient>
<diffuse>1 0 0 1</diffuse>
</material>
</visual>
</link>
<link name="arm">
<pose relative_to="shoulder"/>
</link>
<joint name="shoulder" type="revolute">
<parent>base</parent>
<child>arm</child>
<pose relative_to="base">0 0 0.5 0 0 0</pose>
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
LIMIT = GOOD[GOOD.index("<limit>") : GOOD.index("</axis>")]
VISUAL = GOOD[GOOD.index("<visual ") : GOOD.index("</link>")]
COLOUR = GOOD[GOOD.index("<ambient>") : GOOD.index("</material>")]


def found(text: str) -> tuple[Problem, ...]:
    try:
        return load_robot(text).problems
    except RobotError as error:
        return error.problems


def hints(text: str) -> list[str]:
    return [problem.hint for problem in found(text)]


def test_the_model_of_these_tests_is_good() -> None:
    assert found(GOOD) == ()


@pytest.mark.parametrize("tag", ["model", "link", "joint"])
def test_what_is_closed_too_early_is_to_be_deleted(tag: str) -> None:
    first = {"model": "</link>\n", "link": "</inertial>\n", "joint": "</child>\n"}[tag]
    early = GOOD.replace(first, f"{first}</{tag}>\n", 1)

    (problem,) = found(early)

    line = early[: early.index(f"</{tag}>")].count("\n") + 1
    assert (problem.code, problem.line) == ("xml-closed-early", line)
    assert problem.hint.startswith(f"delete </{tag}> on line {line};")
    assert found(early.replace(f"</{tag}>\n", "", 1)) == ()


def test_a_tag_that_closes_nothing_is_still_one() -> None:
    (problem,) = found(GOOD.replace("</model>", "</link>\n</model>"))

    assert problem.code == "xml-closing-tag-surplus"


def test_all_that_is_behind_the_model_is_one_problem() -> None:
    end = "</model>\n"
    wrong = GOOD.replace(end, "").replace("</link>\n", f"</link>\n{end}", 1)

    (problem,) = found(wrong)

    line = wrong[: wrong.index("<joint")].count("\n") + 1
    last = f"<joint> on line {line}"
    assert problem.hint == f"move </model> down, behind the last of them ({last})"
    assert found(wrong.replace(end, "").replace("</sdf>", f"{end}</sdf>")) == ()


def test_what_is_before_the_model_is_sent_into_it() -> None:
    arm = GOOD[GOOD.index('<link name="arm">') : GOOD.index("<joint ")]
    wrong = GOOD.replace(arm, "").replace("<model", f"{arm}<model", 1)

    assert hints(wrong) == ['move <link> into <model name="bot"> (line 5)']


def test_links_in_a_link_that_is_closed_too_late_are_sent_out_of_it() -> None:
    late = GOOD.replace("</link>\n", "", 1).replace("</model>", "</link>\n</model>")

    problems = found(late)

    assert {(p.code, p.severity) for p in problems} == {
        ("element-misplaced", "warning")
    }
    out = 'out of <link>, directly into <model name="bot">'
    assert sorted(hints(late)) == [f"move <joint> {out}", f"move <link> {out}"]


@pytest.mark.parametrize(
    ("old", "new", "hint"),
    [
        (
            f"{LIMIT}</axis>\n",
            f"</axis>\n{LIMIT}",
            "move <limit> into <axis> (line 28)",
        ),
        (
            f"{VISUAL}</link>\n",
            f"</link>\n{VISUAL}",
            'move <visual> into <link name="base"> (line 3)',
        ),
        (
            "<radius>0.1</radius>\n<length>0.06</length>\n</cylinder>\n",
            "<length>0.06</length>\n</cylinder>\n<radius>0.1</radius>\n",
            "move <radius> into <cylinder> (line 10)",
        ),
        (
            "</ambient>\n<diffuse>1 0 0 1</diffuse>\n</material>\n",
            "</ambient>\n</material>\n<diffuse>1 0 0 1</diffuse>\n",
            "move <diffuse> into <material> (line 15)",
        ),
    ],
)
def test_an_element_beside_its_place_is_moved(old: str, new: str, hint: str) -> None:
    assert old in GOOD

    problems = found(GOOD.replace(old, new))

    assert [problem.hint for problem in problems] == [hint]
    assert problems[0].code == "element-misplaced"


WRAPPED = re.compile(r"write (\S+) before (\S+) and (\S+) behind (\S+)")


@pytest.mark.parametrize(
    ("around", "tags"),
    [
        ("material", ("ambient", "diffuse")),
        ("inertial", ("mass", "inertia")),
        ("geometry", ("cylinder", "cylinder")),
        ("cylinder", ("radius", "length")),
        ("axis", ("xyz", "limit")),
    ],
)
def test_an_element_that_is_missing_around_others_is_put_around_all(
    around: str, tags: tuple[str, str]
) -> None:
    begin, end = f"<{around}>\n", f"</{around}>\n"
    wrong = GOOD.replace(begin, "").replace(end, "")

    problems = found(wrong)

    (hint,) = (problem.hint for problem in problems)
    first, last = f"<{tags[0]}>", f"</{tags[1]}>"
    if tags[0] == tags[1]:
        assert hint == f"write {begin.strip()} before it and {end.strip()} behind it"
    else:
        said = WRAPPED.fullmatch(hint)
        assert said
        assert said.groups() == (begin.strip(), first, end.strip(), last)
    fixed = wrong.replace(first, begin + first, 1).replace(last, f"{last}\n{end}", 1)
    assert found(fixed) == ()


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("<length>0.06</length>", "<height>0.06</height>"),
        ("<radius>0.1</radius>", "<r>0.1</r>"),
        ("<lower>-1</lower>", "<min>-1</min>"),
        ("<xyz>0 1 0</xyz>", "<direction>0 1 0</direction>"),
        ("<mass>2</mass>", "<weight>2</weight>"),
        ("<radius>0.1</radius>", "<diameter>0.2</diameter>"),
        (
            '<pose relative_to="base">0 0 0.5 0 0 0</pose>',
            '<pose relative_to="base" xyz="0 0 0.5"/>',
        ),
        (
            '<pose relative_to="base">0 0 0.5 0 0 0</pose>',
            '<pose relative_to="base" z="0.5"/>',
        ),
    ],
)
def test_a_value_under_another_name_is_kept(right: str, wrong: str) -> None:
    (hint,) = hints(GOOD.replace(right, wrong))

    written = hint.removeprefix("write ")
    fixed = GOOD.replace(right, written)
    assert fixed == GOOD


def test_a_limit_as_in_urdf_beside_the_axis_is_one_problem() -> None:
    wrong = GOOD.replace(LIMIT, "").replace(
        "</axis>", '</axis>\n<limit lower="-1" upper="1"/>'
    )

    (hint,) = hints(wrong)

    inner = hint.removeprefix("write ").removesuffix(" inside <axis>")
    fixed = GOOD.replace(LIMIT, f"{inner}\n")
    assert inner == "".join(LIMIT.split())
    assert found(fixed) == ()


@pytest.mark.parametrize("tag", ["geometry", "cylinder"])
def test_a_shape_directly_in_a_link_gets_a_named_visual(tag: str) -> None:
    begin = '<visual name="shell">\n'
    inner = "" if tag == "geometry" else "geometry"
    inside = VISUAL[VISUAL.index(f"<{tag}>") : VISUAL.index(f"</{tag}>")]
    inside += f"</{tag}>\n"
    wrong = GOOD.replace(VISUAL, inside)

    (hint,) = hints(wrong)

    opened, closed = (f"<{inner}>", f"</{inner}>") if inner else ("", "")
    begin = f'<visual name="base_visual">{opened}'
    end = f"{closed}</visual>"
    assert hint == f"write {begin} before it and {end} behind it"
    assert found(wrong.replace(inside, f"{begin}{inside}{end}")) == ()
