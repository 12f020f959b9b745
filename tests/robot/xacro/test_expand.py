import os
import subprocess
import sys
from pathlib import Path

import pytest

from sambot_viz.errors import Place, Problem, RobotError
from sambot_viz.robot.load import expand
from sambot_viz.robot.model import load_robot
from sambot_viz.robot.xacro.child_result import ExpansionError
from sambot_viz.robot.xacro.expansion import Limits, expand_model

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'


def write(path: Path, inside: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"{HEAD}{inside}</robot>\n", "utf-8")
    return path


def errors(model: Path | str, **options: object) -> list[Problem]:
    with pytest.raises(RobotError) as caught:
        load_robot(model, **options)  # type: ignore[arg-type]
    return [p for p in caught.value.problems if p.severity == "error"]


MACRO = """<xacro:macro name="wheel" params="side y">
  <link name="${side}_wheel">
    <visual><geometry><sphere radius="${y}"/></geometry></visual>
  </link>
</xacro:macro>
"""


def test_the_text_is_what_the_xacro_command_prints(tmp_path: Path):
    model = write(
        tmp_path / "m.urdf.xacro",
        MACRO + '<!-- kept --><xacro:wheel side="l" y="${0.1 + 0.2}"/>\n'
        '<gazebo b="2" a="1">텍스트 &amp; more</gazebo>',
    )
    command = [sys.executable, "-m", "xacro", str(model)]
    program = "import xacro; xacro.main()"
    command = [sys.executable, "-X", "utf8", "-c", program, str(model)]
    printed = subprocess.run(command, capture_output=True, check=True).stdout

    assert expand(model) == printed.decode("utf-8")


def test_every_element_keeps_its_file_and_line(tmp_path: Path):
    write(tmp_path / "parts" / "wheel.xacro", MACRO)
    model = write(
        tmp_path / "m.xacro",
        '<link name="base"/>\n'
        '<xacro:include filename="parts/wheel.xacro"/>\n'
        '<xacro:if value="true">\n'
        '<xacro:wheel side="l" y="0.1"/>\n'
        "</xacro:if>\n"
        '<joint name="j" type="fixed">\n'
        '<parent link="base"/><child link="l_wheel"/></joint>\n',
    )
    robot = load_robot(model)
    part = str(tmp_path / "parts" / "wheel.xacro")

    assert robot.links["base"].place == Place(str(model), 2, 1)
    assert robot.links["l_wheel"].place == Place(part, 3, 3)
    assert robot.links["l_wheel"].visuals[0].place == Place(part, 4, 5)
    assert robot.joints["j"].place == Place(str(model), 7, 1)
    assert robot.files == (model, Path(part))


def test_an_error_in_a_macro_names_its_body_and_its_call(tmp_path: Path):
    model = write(
        tmp_path / "m.xacro",
        MACRO + '<xacro:macro name="axle" params="y">\n'
        '<xacro:wheel side="l" y="${y}"/></xacro:macro>\n'
        '<xacro:axle y="wide"/>\n',
    )
    problem = load_robot(model).problems[0]

    assert (problem.code, problem.line) == ("number-malformed", 4)
    assert "from the macro call on line 9" in problem.message


def test_a_block_keeps_the_place_where_it_was_given(tmp_path: Path):
    model = write(
        tmp_path / "m.xacro",
        '<xacro:macro name="body" params="*shape">\n<link name="a">\n'
        "<visual><geometry>\n"
        '<xacro:insert_block name="shape"/></geometry></visual></link>\n'
        "</xacro:macro>\n"
        "<xacro:body>\n"
        '<sphere radius="x"/>\n'
        "</xacro:body>\n",
    )
    assert load_robot(model).problems[0].line == 8


def test_arguments_are_given_and_default(tmp_path: Path):
    model = write(
        tmp_path / "m.xacro",
        '<xacro:arg name="prefix" default="a_"/><link name="$(arg prefix)base"/>',
    )
    assert load_robot(model).root == "a_base"
    assert load_robot(model, xacro_args={"prefix": "b_"}).root == "b_base"


def test_the_content_decides_whether_xacro_is_needed():
    substituted = load_robot('<robot name="r"><link name="a${1 + 1}"/></robot>')
    assert substituted.root == "a2"
    in_plugin = load_robot(
        '<robot name="r"><link name="a"/><!-- ${x} $(find none) -->'
        "<gazebo><plugin><file>$(find none)/x.yaml</file></plugin></gazebo></robot>"
    )
    assert in_plugin.problems == ()


def test_a_finished_urdf_that_contains_xacro_is_expanded_with_a_note(tmp_path: Path):
    model = write(tmp_path / "m.urdf", '<link name="a"/>\n<xacro:property name="x"/>')
    problems = load_robot(model).problems
    assert [(p.code, p.severity, p.line) for p in problems] == [
        ("xacro-in-urdf", "info", 3)
    ]


def test_packages_are_found_without_ros(tmp_path: Path):
    own = tmp_path / "ws" / "my robot"
    write(own / "urdf" / "part.xacro", '<link name="from_part"/>')
    (own / "package.xml").write_text("<package><name>로봇</name></package>", "utf-8")
    find = '<xacro:include filename="$(find 로봇)/urdf/part.xacro"/>'
    model = write(own / "urdf" / "m.xacro", find)
    uri = '<xacro:include filename="package://로봇/urdf/part.xacro"/>'
    by_uri = write(own / "urdf" / "n.xacro", uri)

    assert load_robot(model).root == "from_part"
    assert load_robot(by_uri).root == "from_part"


def test_a_source_tree_may_have_another_layout_than_the_package(tmp_path: Path):
    (tmp_path / "package.xml").write_text("<name>demo</name>")
    write(tmp_path / "description" / "ros2_control" / "x.xacro", '<link name="a"/>')
    find = '<xacro:include filename="$(find demo)/ros2_control/x.xacro"/>'
    model = write(tmp_path / "description" / "urdf" / "m.xacro", find)
    assert load_robot(model).root == "a"


def test_a_file_that_is_being_included_never_replaces_a_missing_one(tmp_path: Path):
    (tmp_path / "package.xml").write_text("<name>demo</name>")
    find = '<xacro:include filename="$(find demo)/urdf/m.xacro"/>'
    model = write(tmp_path / "src" / "urdf" / "m.xacro", find)
    assert errors(model)[0].code == "xacro-include-missing"
    model.write_text(model.read_text().replace("urdf/m.xacro", "src/urdf/m"))
    assert errors(model)[0].hint == "correct the path, or put the file there"


def test_a_missing_package_is_named_with_the_line_and_the_places(tmp_path: Path):
    find = '<xacro:include filename="$(find nowhere)/x.xacro"/>'
    problem = errors(write(tmp_path / "m.xacro", f"\n{find}"))[0]
    assert problem.line == 3
    assert "nowhere" in problem.message
    assert str(tmp_path) in problem.message


def test_warnings_of_xacro_become_problems(tmp_path: Path):
    model = write(
        tmp_path / "m.xacro",
        '<link name="a"/>\n<xacro:property name="pi" value="3"/>\n'
        "<!-- ${xacro.warning('not read')} -->\n"
        '<gazebo>${xacro.warning("my own")}</gazebo>\n',
    )
    found = [(p.code, p.message, p.line) for p in load_robot(model).problems]
    assert found == [
        ("xacro-warning", "redefining global symbol: pi", 3),
        ("xacro-warning", "my own", 5),
    ]


def test_a_call_without_its_prefix_is_the_reason_for_an_empty_robot(tmp_path: Path):
    problems = errors(write(tmp_path / "m.xacro", MACRO + "<wheel/>"))
    assert [(p.code, p.line) for p in problems] == [("xacro-prefix-missing", 7)]
    assert problems[0].hint == "write <xacro:wheel>"


@pytest.mark.parametrize("tag", ["ros2_control", "gazebo"])
def test_a_macro_may_have_the_name_of_what_it_makes(tmp_path: Path, tag: str) -> None:
    macro = f'<xacro:macro name="{tag}"><{tag} name="a"/></xacro:macro>\n'
    inside = f'<link name="a"/>\n{macro}<xacro:{tag}/>\n'
    assert load_robot(write(tmp_path / "m.xacro", inside)).problems == ()


def test_a_library_names_its_macros_and_the_file_that_includes_it(tmp_path: Path):
    library = write(tmp_path / "wheel.xacro", MACRO)
    assert "call it: <xacro:wheel …/>" in errors(library)[0].hint
    write(tmp_path / "robot.xacro", '<xacro:include filename="wheel.xacro"/>')
    problem = errors(library)[0]
    assert problem.code == "robot-without-links"
    assert "only defines the macro wheel" in problem.message
    assert problem.hint == "open a file that includes it: robot.xacro"


def test_the_files_that_include_one_are_named_in_the_order_of_their_names(
    tmp_path: Path,
):
    part = tmp_path / "part.xacro"
    part.write_text('<robot xmlns:xacro="http://ros.org/wiki/xacro"/>')
    for name in ("e", "b", "d", "c"):
        (tmp_path / f"{name}.xacro").write_text(
            '<xacro:include filename="part.xacro"/>'
        )
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "a.xacro").write_text('<xacro:include filename="part.xacro"/>')

    with pytest.raises(RobotError) as caught:
        load_robot(part)
    hint = caught.value.problems[0].hint
    assert hint == "open a file that includes it: b.xacro, c.xacro, d.xacro"


def test_broken_xml_in_an_included_file_is_explained_in_that_file(tmp_path: Path):
    part = tmp_path / "part.xacro"
    part.write_text('<robot>\n<link name="a">\n</robot>\n')
    problem = errors(
        write(tmp_path / "m.xacro", '<xacro:include filename="part.xacro"/>')
    )[0]
    assert problem.file == str(part)
    assert problem.line is not None


def test_included_file_names_are_shown_as_the_model_was_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    write(tmp_path / "sub" / "part.xacro", '<link name="a"/>')
    write(tmp_path / "sub" / "m.xacro", '<xacro:include filename="part.xacro"/>')
    monkeypatch.chdir(tmp_path)
    place = load_robot(os.path.join("sub", "m.xacro")).links["a"].place
    assert place is not None
    assert place.file == os.path.join("sub", "part.xacro")


def test_a_macro_may_nest_deeply(tmp_path: Path):
    model = write(
        tmp_path / "m.xacro",
        '<xacro:macro name="chain" params="n"><link name="l${n}"/>\n'
        '<joint name="j${n}" type="fixed"><parent link="l${n}"/>'
        '<child link="l${n - 1}"/></joint>\n'
        '<xacro:if value="${n > 1}"><xacro:chain n="${n - 1}"/></xacro:if>'
        '</xacro:macro><link name="l0"/><xacro:chain n="100"/>',
    )
    assert len(load_robot(model).links) == 101


def test_secrets_are_not_in_the_environment_of_an_expansion(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setenv("MY_API_TOKEN", "secret")
    monkeypatch.setenv("SAMBOT_VIZ_PRESENTER", "secret")
    monkeypatch.setenv("DATABASE", "postgres://me:secret@host/")
    monkeypatch.setenv("MY_PREFIX", "front")

    def read(name: str) -> str:
        return load_robot(f'{HEAD}<link name="$(optenv {name} none)"/></robot>').root

    assert read("MY_PREFIX") == "front"
    assert read("MY_API_TOKEN") == read("SAMBOT_VIZ_PRESENTER") == "none"
    assert read("DATABASE") == "none"
    assert read("ROS_VERSION") == "2"


def test_an_argument_of_the_root_tag_has_to_be_given(tmp_path: Path):
    model = tmp_path / "m.xacro"
    model.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="$(arg name)">\n'
        '<xacro:arg name="name" default="ur"/>\n<link name="a"/></robot>'
    )
    problem = errors(model)[0]
    assert (problem.code, problem.line) == ("xacro-arg-after-use", 1)
    assert problem.hint == "give it on the command line: name:=ur"
    assert load_robot(model, xacro_args={"name": "ur"}).name == "ur"


def test_expressions_that_give_invalid_xml_are_an_error(tmp_path: Path):
    for inside in (
        '\n<link name="a"/><xacro:element xacro:name="${\'x y\'}"/>',
        "\n<link name=\"a${'\\x01'}\"/>",
    ):
        problem = errors(write(tmp_path / "m.xacro", inside))[0]
        assert (problem.code, problem.line) == ("xacro-output-not-xml", 3)


# --- limits -------------------------------------------------------------------


def expansion(inside: str, limits: Limits) -> ExpansionError:
    with pytest.raises(ExpansionError) as caught:
        expand_model(
            "<text>",
            f"{HEAD}{inside}</robot>",
            arguments={},
            package_path=(),
            trusted=True,
            limits=limits,
        )
    return caught.value


def test_an_expansion_that_takes_too_long_is_ended():
    endless = '<link name="${python.sum(python.range(10**15))}"/>'
    error = expansion(endless.replace("python.range", "range"), Limits(seconds=0.5))
    assert error.failure.kind == "Timeout"
    assert "longer than 0.5 s" in error.failure.text


def test_an_expansion_that_needs_too_much_memory_is_ended():
    error = expansion("<link name=\"${'a' * 10**11}\"/>", Limits())
    assert error.failure.kind == "MemoryError"


def test_an_expansion_with_too_much_output_is_ended():
    error = expansion("<link name=\"${'a' * 10000}\"/>", Limits(characters=5000))
    assert error.failure.kind == "OutputLimit"


def test_a_macro_that_calls_itself_without_end_is_an_error():
    again = '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>'
    error = expansion(again, Limits())
    assert error.failure.kind == "RecursionError"
