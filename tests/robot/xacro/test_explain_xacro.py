from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from sambot_viz.errors import Problem, RobotError
from sambot_viz.robot.model import load_robot
from sambot_viz.robot.packages.package_index import Lookup
from sambot_viz.robot.xacro.child_result import Definition, XacroCall, XacroFailure
from sambot_viz.robot.xacro.diagnose.explain_xacro import explain_xacro

Explain = Callable[..., Problem]

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'


@pytest.fixture
def explain(tmp_path: Path) -> Explain:
    """Explains a made-up failure in a file with these lines after <robot …>."""

    def run(body: str, text: str, kind: str = "XacroException", **facts: object):
        file = tmp_path / "r.xacro"
        file.write_text(f"{HEAD}{body}\n</robot>\n")
        failure = XacroFailure(kind, text, str(file), **facts)  # type: ignore[arg-type]
        (problem,) = explain_xacro(failure, str(file))
        assert problem.severity == "error"
        assert problem.file == str(file)
        assert problem.hint
        return problem

    return run


def undefined(name: str) -> tuple[str, str]:
    return f"name '{name}' is not defined", "NameError"


def test_a_misspelt_property_gets_the_nearest_one_with_its_line(
    explain: Explain,
) -> None:
    problem = explain(
        '<xacro:property name="radius" value="1"/>\n<link name="${radus*2}"/>',
        *undefined("radus"),
        expressions=("radus*2",),
        line=3,
    )

    assert problem.code == "xacro-undefined-name"
    assert problem.line == 3
    assert problem.hint == "did you mean radius (defined on line 2)?"


def test_the_macro_call_is_named_beside_the_macro_body(
    explain: Explain, tmp_path: Path
) -> None:
    file = str(tmp_path / "r.xacro")
    problem = explain(
        '<xacro:macro name="m">\n<link name="${x}"/>\n</xacro:macro>\n<xacro:m/>',
        *undefined("x"),
        expressions=("x",),
        line=3,
        macros=(("m", file),),
        calls=(XacroCall("m", file, 5),),
    )

    assert problem.line == 3
    assert problem.message == "x is not defined (in macro m, called on line 5)"


def test_the_expression_is_found_in_a_lazy_property(
    explain: Explain,
) -> None:
    problem = explain(
        '<xacro:property name="a" value="${b + 1}"/>\n<link name="${a}"/>',
        *undefined("b"),
        expressions=("b + 1", "a"),
        line=3,
    )

    assert problem.line == 2


def test_an_expression_in_a_comment_is_not_taken_for_the_failed_one(
    explain: Explain,
) -> None:
    problem = explain(
        '<!-- ${x} -->\n<link name="${x}"/>', *undefined("x"), expressions=("x",)
    )

    assert problem.line == 3


@pytest.mark.parametrize(
    ("body", "name", "hint"),
    [
        ('<xacro:arg name="x" default="1"/>', "x", "x is an argument: write $(arg x)"),
        ("", "abs", "write python.abs(…): xacro keeps it under python"),
        ("", "PI", "write pi"),
        ("", "radian", "did you mean radians?"),
        ("", "zzz", 'add <xacro:property name="zzz" value="…"/> before it'),
    ],
)
def test_a_name_of_another_kind_is_explained(
    explain: Explain, body: str, name: str, hint: str
) -> None:
    problem = explain(f'{body}<link name="${{{name}}}"/>', *undefined(name))

    assert problem.hint.startswith(hint)


def test_a_property_inside_a_macro_is_not_known_outside(explain: Explain) -> None:
    problem = explain(
        '<xacro:macro name="m">\n<xacro:property name="x" value="1"/>\n</xacro:macro>\n'
        '<link name="${x}"/>',
        *undefined("x"),
        line=5,
    )

    assert "only inside the macro m" in problem.message
    assert 'scope="parent"' in problem.hint


def test_a_definition_without_prefix_is_the_reported_place(explain: Explain) -> None:
    problem = explain(
        '<macro name="m"/>\n<xacro:m/>', "unknown macro name: xacro:m", line=3
    )

    assert problem.code == "xacro-prefix-forgotten"
    assert problem.line == 2


def test_a_misspelt_xacro_element_is_recognised(explain: Explain) -> None:
    problem = explain(
        '<xacro:proprty name="x" value="1"/>', "unknown macro name: xacro:proprty"
    )

    assert problem.hint == "write <xacro:property …>"


def test_a_file_beside_the_model_that_has_the_macro_is_named(
    explain: Explain, tmp_path: Path
) -> None:
    (tmp_path / "wheels.xacro").write_text('<robot><xacro:macro name="m"/></robot>')
    problem = explain("<xacro:m/>", "unknown macro name: xacro:m", line=2)

    assert problem.code == "xacro-include-forgotten"
    assert "wheels.xacro defines it on line 1" in problem.message


def test_a_macro_known_only_to_the_child_is_suggested(explain: Explain) -> None:
    problem = explain(
        "<xacro:wheeel/>",
        "unknown macro name: xacro:wheeel",
        line=2,
        definitions=(Definition("macro", "wheel", "/elsewhere/w.xacro", 7),),
    )

    assert problem.hint == "did you mean wheel (line 7 of /elsewhere/w.xacro)?"


def test_an_unknown_parameter_gets_the_nearest_one(
    explain: Explain, tmp_path: Path
) -> None:
    problem = explain(
        '<xacro:macro name="m" params="side:=1 *block"/>\n<xacro:m sde="1"/>',
        'Invalid parameter "sde"',
        line=3,
        element="xacro:m",
        macros=(("m", str(tmp_path / "r.xacro")),),
    )

    assert problem.message == "the macro m has no parameter sde (declared on line 2)"
    assert problem.hint == 'write side="1"'


def test_a_missing_argument_is_reported_where_it_is_used(
    explain: Explain,
) -> None:
    problem = explain(
        '<link name="$(arg base)"/>',
        "base",
        kind="ArgException",
        line=2,
        macros=(("m", "m.xacro"),),
    )

    assert problem.code == "xacro-argument-missing"
    assert (problem.line, problem.column) == (2, 13)
    assert "base:=…" in problem.hint


def test_a_missing_package_lists_the_searched_folders_and_a_similar_name(
    explain: Explain, tmp_path: Path
) -> None:
    problem = explain(
        '<xacro:include filename="$(find sambot)/a.xacro"/>',
        "package 'sambot' not found",
        kind="PackageNotFoundError",
        line=2,
        missing_package=Lookup(
            "sambot", None, (str(tmp_path / "ws"), "/nowhere"), ("other", "sam_bot")
        ),
    )

    assert f"looked in {tmp_path / 'ws'}, /nowhere" in problem.message
    assert problem.hint.startswith("did you mean 'sam_bot'? If not, give")


def test_a_misspelt_include_suggests_a_similar_file(
    explain: Explain, tmp_path: Path
) -> None:
    (tmp_path / "wheels.xacro").write_text("<robot/>")
    problem = explain(
        '<xacro:include filename="wheel.xacro"/>',
        f"[Errno 2] No such file or directory: '{tmp_path / 'wheel.xacro'}'",
        kind="FileNotFoundError",
        line=2,
    )

    assert problem.code == "xacro-include-missing"
    assert problem.hint == "write wheels.xacro"


@pytest.mark.parametrize(
    ("kind", "code"),
    [
        ("Timeout", "xacro-timeout"),
        ("OutputLimit", "xacro-too-large"),
        ("MemoryError", "xacro-too-large"),
        ("RecursionError", "xacro-recursion"),
        ("Refused", "xacro-refused"),
        ("Crash", "xacro-failed"),
    ],
)
def test_limits_and_crashes_have_their_own_messages(
    explain: Explain, kind: str, code: str
) -> None:
    assert explain("", "it ended", kind=kind).code == code


def test_a_failure_in_a_deleted_file_is_explained() -> None:
    failure = XacroFailure("NameError", "name 'x' is not defined", "gone.xacro", 3)

    (problem,) = explain_xacro(failure, "gone.xacro")

    assert (problem.file, problem.line) == ("gone.xacro", 3)


def test_what_xacro_really_reports_is_explained_at_its_line(tmp_path: Path) -> None:
    file = tmp_path / "r.xacro"
    file.write_text(f'{HEAD}<link\n  name="${{radius}}"/>\n</robot>\n')

    with pytest.raises(RobotError) as caught:
        load_robot(file)

    (problem,) = caught.value.problems
    assert problem.code == "xacro-undefined-name"
    assert problem.line == 3
