"""The command line: what it prints, and how it ends."""

from __future__ import annotations

import json
import os
import re
import signal
import struct
import subprocess
import sys
from pathlib import Path
from urllib.request import urlopen

import pytest
from program import address, rest_of, running, serving

from sambot_viz import Visualizer, bundled, load_robot
from sambot_viz.cli import main

Capture = pytest.CaptureFixture[str]


def test_it_prints_one_line_with_the_address_and_serves_the_page(
    tmp_path: Path,
) -> None:
    with running("--port", "0", cwd=tmp_path) as process:
        url = address(process)
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+", url)
        with urlopen(url) as page:
            assert page.status == 200
        process.send_signal(signal.SIGINT)
        out, err = rest_of(process)
        assert process.returncode == 0
        assert (out, err) == ("", "")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["exprt", "x.urdf"], "did you mean 'export'?"),
        (["chek"], "did you mean 'check'?"),
        (["--config", "own.rviz"], "unrecognized arguments: --config"),
        (["--prot", "80"], "did you mean --port?"),
        (["check", "--formt=json"], "did you mean --format?"),
        (["class", "diff-drive", "--metrics"], "--metrics is a flag of other commands"),
        (["index", "--metrics"], "--metrics is a flag of other commands, not of this"),
        (["--zzz"], "unrecognized arguments: --zzz; see sambot-viz --help"),
    ],
)
def test_a_mistyped_word_is_answered_with_the_nearest(
    words: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    try:
        code: object = main(words)
    except SystemExit as end:
        code = end.code
    assert code == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        (["-d", "arn.rviz"], "did you mean 'arm.rviz'?"),
        (["config", "arn.rviz"], "did you mean 'arm.rviz'?"),
        (["-d", "arm.urdf.bak"], "known: 'arm.rviz', 'k.rviz'"),
        # A robot is no config, and the ending says nothing of the name.
        (["-d", "robot.rviz"], "known: 'arm.rviz', 'k.rviz'"),
        (["robot.rviz"], "known: 'arm.rviz', 'k.rviz'"),
        (["arm.rvi"], "did you mean 'arm.urdf'?"),
        (["arn.urdf.xacro"], "did you mean 'arm.urdf.xacro'?"),
        (["xyz.urdf"], "known: 'arm.urdf', 'arm.urdf.xacro', 'robots.urdf'"),
    ],
)
def test_a_mistyped_file_is_answered_with_one_of_its_kind(
    words: list[str],
    offered: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("arm.urdf", "arm.urdf.xacro", "robots.urdf", "arm.rviz", "k.rviz"):
        Path(name).touch()
    assert main(words) == 2
    assert capsys.readouterr().err.endswith(f"there is no such file; {offered}\n")


@pytest.mark.parametrize(
    ("words", "near"),
    [
        (["-d", "nope.rviz"], "known: 'rviz/arm.rviz'"),
        (["config", "nope.rviz"], "known: 'rviz/arm.rviz'"),
        (["nope.urdf"], "this folder has no *.urdf.xacro or *.urdf or *.xacro"),
        (["nope.db3"], "this folder has no *.mcap or *.db3 or *.bag"),
        (["-d", "rviz/none/a.rviz"], "the folder 'rviz/none' does not exist"),
        (["-d", "empty/a.rviz"], "the folder 'empty' has no *.rviz"),
    ],
)
def test_a_missing_file_is_answered_with_where_others_of_its_kind_are(
    words: list[str],
    near: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.chdir(tmp_path)
    for folder in ("rviz", "empty"):
        Path(folder).mkdir()
    Path("rviz", "arm.rviz").touch()
    assert main(words) == 2
    said = capsys.readouterr().err
    assert f"'{words[-1]}'" in said and near in said


@pytest.mark.parametrize("name", ["notes.mcap", "notes.db3", "notes.bag", "none.mcap"])
def test_what_is_wrong_with_a_recording_is_said_as_that_of_a_model(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    if name.startswith("notes"):
        Path(name).write_text("a note\n")
    assert main(["topics", "--source", f"bag:{name}"]) == 1
    err = capsys.readouterr().err
    assert err.startswith(f"{name}: error[file-") and err.count("error") == 1


def test_a_model_whose_name_is_nearly_a_command_is_a_model(
    tmp_path: Path,
) -> None:
    (tmp_path / "exports").write_text('<robot name="r"><link name="a"/></robot>')
    with serving("exports", "--port", "0", cwd=tmp_path) as program:
        assert address(program).startswith("http://")


def test_the_secrets_may_come_from_variables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SAMBOT_VIZ_TOKEN", "of-the-environment")
    with serving("--port", "0", cwd=tmp_path) as program:
        assert address(program).endswith("/?token=of-the-environment")
    with serving("--port", "0", "--token=of-the-line", cwd=tmp_path) as program:
        assert address(program).endswith("/?token=of-the-line")
    monkeypatch.setenv("SAMBOT_VIZ_PRESENTER", "of-the-teacher")
    for flags in ((), ("--presenter", "--token")):
        with serving("--port", "0", *flags, cwd=tmp_path) as program:
            assert address(program).endswith("/?view=of-the-environment")
            assert address(program).endswith("/?present=of-the-teacher")


def test_a_half_open_connection_leaves_no_traceback(tmp_path: Path) -> None:
    import socket

    with running("--port", "0", cwd=tmp_path) as process:
        port = int(address(process).rsplit(":", 1)[1])
        for greeting in (b"", b"GET / HT", b"\x16\x03\x01 no http at all\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", port)) as connection:
                connection.sendall(greeting)
        with urlopen(f"http://127.0.0.1:{port}") as page:
            assert page.status == 200
        process.send_signal(signal.SIGTERM)
        _, err = rest_of(process)
        assert err == ""


@pytest.mark.skipif(sys.platform == "win32", reason="uses a shell script")
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGTERM, 143), (signal.SIGINT, 130)]
)
def test_a_snapshot_that_is_ended_removes_what_its_browser_wrote(
    number: signal.Signals,
    code: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # A browser that reports its start by opening a pipe, and then never answers.
    started = tmp_path / "started"
    os.mkfifo(started)
    browser = tmp_path / "browser"
    browser.write_text(f"#!/bin/sh\necho $$ > {started}\nexec sleep 60\n")
    browser.chmod(0o755)
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setenv("SAMBOT_VIZ_BROWSER", str(browser))
    monkeypatch.setenv("TMPDIR", str(folder))
    with running("snapshot", "-o", str(tmp_path / "a.png")) as process:
        started.read_text()
        assert list(folder.iterdir())
        process.send_signal(number)
        _, err = rest_of(process)
        assert (process.returncode, err) == (code, "")
    assert list(folder.iterdir()) == []


def test_the_students_file_ends_with_the_line_the_cause_and_the_fix(
    shared: Path, capsys: Capture
) -> None:
    model = str(shared / "data/seed/robot_closed_too_early.urdf.xacro")
    for words in ([model, "--port", "0", "--no-watch"], ["check", model]):
        assert main(words) == 1
        out, err = capsys.readouterr()
        said = out + err
        assert "xml-root-closed-early" in said
        assert "line 4 closes </robot> too early" in said
        assert "move </robot>" in said
        assert "Traceback" not in said


def test_check_reports_no_error_for_a_good_model(
    repository: Path, capsys: Capture
) -> None:
    assert main(["check", str(repository / "assets" / "sam_bot.urdf.xacro")]) == 0
    assert "error[" not in capsys.readouterr().out


def test_check_prints_json_for_graders(tmp_path: Path, capsys: Capture) -> None:
    model = tmp_path / "two_roots.urdf"
    model.write_text('<robot name="r">\n<link name="a"/>\n<link name="b"/>\n</robot>')
    assert main(["check", str(model), "--format", "json"]) == 1
    report = json.loads(capsys.readouterr().out)
    assert report["model"] == str(model)
    keys = {"severity", "code", "message", "hint", "file", "line", "column"}
    assert report["problems"]
    assert set(report["problems"][0]) == {*keys, "count", "more_places", "edits"}


def test_the_json_of_check_has_one_row_for_each_cause(
    tmp_path: Path, capsys: Capture
) -> None:
    model, name = tmp_path / "r.urdf", "package://arm/{}.stl"
    shapes = "\n".join(
        f'<visual><geometry><mesh filename="{name.format(n)}"/></geometry></visual>'
        for n in range(9)
    )
    model.write_text(f'<robot name="r"><link name="a">\n{shapes}\n</link></robot>')
    assert main(["check", str(model), "--format", "json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)["problems"]
    assert row["message"] == "9 meshes of package arm: not found"
    assert (row["line"], row["count"]) == (2, 9)
    assert [place["line"] for place in row["more_places"]] == list(range(3, 11))
    assert {place["file"] for place in row["more_places"]} == {str(model)}


def test_expand_prints_the_urdf(repository: Path, capsys: Capture) -> None:
    assert main(["expand", str(repository / "assets" / "sam_bot.urdf.xacro")]) == 0
    out = capsys.readouterr().out
    assert '<robot name="sam_bot">' in out and "xacro:" not in out


def test_expand_prints_sdf_as_it_is_or_as_the_urdf_that_ros_makes_of_it(
    repository: Path, capsys: Capture
) -> None:
    model = str(repository / "assets" / "sam_bot.sdf")
    assert main(["expand", model]) == 0
    out = capsys.readouterr().out
    assert "<sdf version=" in out and "<xacro:" not in out
    assert main(["expand", "--to", "urdf", model]) == 0
    printed = capsys.readouterr()
    assert load_robot(printed.out) == load_robot(load_robot(model).urdf)
    assert printed.err == ""


def test_expand_to_urdf_prints_a_urdf_as_it_is(
    repository: Path, capsys: Capture
) -> None:
    model = str(repository / "assets" / "sam_bot.urdf.xacro")
    printed: list[str] = []
    for words in (["expand", model], ["expand", "--to", "urdf", model]):
        assert main(words) == 0
        printed.append(capsys.readouterr().out)
    assert printed[0] == printed[1]


def test_what_a_urdf_cannot_say_of_an_sdf_file_is_said_beside_it(
    tmp_path: Path, capsys: Capture
) -> None:
    model = tmp_path / "r.sdf"
    joint = '<joint name="j" type="{}"><parent>a</parent><child>b</child>{}</joint>'
    text = f'<sdf version="1.8"><model name="r"><link name="a"/><link name="b"/>{joint}'
    model.write_text(f"{text.format('ball', '')}</model></sdf>")
    assert main(["expand", "--to", "urdf", str(model)]) == 0
    printed = capsys.readouterr()
    assert load_robot(printed.out).joints["j"].type == "floating"
    assert "sdf-joint-floating" in printed.err
    model.write_text(f"{text.format('hinge', '')}</model></sdf>")
    assert main(["expand", "--to", "urdf", str(model)]) == 1
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "joint-type-unknown" in printed.err


def test_xacro_arguments_may_be_anywhere(tmp_path: Path, capsys: Capture) -> None:
    model = tmp_path / "r.xacro"
    model.write_text(
        '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">'
        '<xacro:arg name="size" default="1"/><link name="l$(arg size)"/></robot>'
    )
    assert main(["expand", "size:=7", str(model)]) == 0
    assert '<link name="l7"/>' in capsys.readouterr().out
    assert main(["expand", f"model:={model}", "size:=8"]) == 0
    assert '<link name="l8"/>' in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["missing.urdf"], 2, "no model 'missing.urdf': there is no such file"),
        (["-d", "missing.rviz"], 2, "no config 'missing.rviz'"),
        (["-f", "", "--port", "0"], 2, "the fixed frame has an empty name"),
        (["--port", "70000"], 1, "port 70000 does not exist"),
        (["--port", "many"], 2, "invalid int value: 'many'"),
        (["--bogus"], 2, "unrecognized arguments: --bogus"),
        (["gui:=perhaps"], 2, "gui:=perhaps is neither true nor false"),
        (["a.urdf", "--model", "b.urdf"], 2, "two models given: 'a.urdf' and 'b.urdf'"),
        (["check", "--format", "xml"], 2, "invalid choice: 'xml'"),
        (["--host", "203.0.113.7", "--port", "0"], 1, "no such address"),
    ],
)
def test_a_bad_command_line_is_one_clear_line(
    words: list[str], code: int, said: str, capsys: Capture
) -> None:
    try:
        ended = main(words)
    except SystemExit as end:
        ended = end.code
    _, err = capsys.readouterr()
    assert ended == code
    assert said in err and err.count("\n") == 1 and "Traceback" not in err


def test_a_taken_port_is_one_clear_line(capsys: Capture) -> None:
    with Visualizer(port=0) as viz:
        port = viz.url.rsplit(":", 1)[1]
        assert main(["--port", port]) == 1
    _, err = capsys.readouterr()
    assert f"port {port} on 127.0.0.1 is taken" in err and err.count("\n") == 1


@pytest.fixture
def doubtful(tmp_path: Path) -> Path:
    """A model with two warnings."""
    model = tmp_path / "doubtful.urdf"
    model.write_text(
        '<robot name="r"><link name="a"><visual><geometry><mesh filename="a.stl"/>'
        '</geometry></visual></link><link name="b"><visual><geometry>'
        '<mesh filename="b.stl"/></geometry></visual></link>'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
        "</robot>"
    )
    return model


def test_the_work_goes_on_when_nothing_reads_standard_error(
    doubtful: Path, tmp_path: Path
) -> None:
    tree = tmp_path / "tree.svg"
    reader, writer = os.pipe()
    os.close(reader)
    try:
        ended = subprocess.run(
            [sys.executable, "-m", "sambot_viz", "frames", doubtful, "-o", tree],
            stderr=writer,
            stdout=writer,
            check=False,
        )
    finally:
        os.close(writer)
    assert ended.returncode == 0
    assert "</svg>" in tree.read_text()


def test_poses_that_a_browser_saves_are_kept_beside_the_model(tmp_path: Path) -> None:
    from protocol_client import ProtocolClient

    model = tmp_path / "arm.urdf"
    model.write_text(
        '<robot name="arm"><link name="a"/><link name="b"/>'
        '<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>'
        "</robot>"
    )
    with serving(str(model), "--port", "0", cwd=tmp_path) as program:
        client = ProtocolClient(int(address(program).rsplit(":", 1)[1]))
        # Before it has joined, its own rows are not there, and its edits do nothing.
        client.wait_until(lambda: {"poses/save", "role/me"} <= client.rows.keys())
        client.act("poses/save", "half")
        client.wait_until(lambda: (tmp_path / "arm.poses.yaml").is_file())
        client.close()
    assert "half" in (tmp_path / "arm.poses.yaml").read_text()


def test_a_config_with_a_yaml_error_names_the_line(
    tmp_path: Path, capsys: Capture
) -> None:
    config = tmp_path / "broken.rviz"
    config.write_text("Panels:\n  - Class: a\n Name: b\n")
    assert main(["-d", str(config), "--port", "0", "--no-watch"]) == 1
    assert f"{config}:3" in capsys.readouterr().err


def test_a_package_folder_shows_its_own_model_and_config(
    tmp_path: Path, repository: Path
) -> None:
    package = tmp_path / "my_bot"
    (package / "urdf").mkdir(parents=True)
    (package / "rviz").mkdir()
    model = package / "urdf" / "my_bot.urdf"
    model.write_text('<robot name="my"><link name="hull"/></robot>')
    config = repository / "rviz" / "urdf_config.rviz"
    (package / "rviz" / "view.rviz").write_text(config.read_text())
    from sambot_viz.bundled import find

    found = find(package)
    assert (found.model, found.config) == (model, package / "rviz" / "view.rviz")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["check", "LONG"], "no model '"),
        (["frames", "LONG.urdf"], "no model '"),
        (["-d", "LONG.rviz", "--port", "0"], "no config '"),
        (["frames", "-o", "LONG.svg"], "File name too long"),
    ],
)
def test_a_name_that_no_file_system_takes_is_one_clear_line(
    words: list[str], said: str, capsys: Capture
) -> None:
    assert main([word.replace("LONG", "a" * 300) for word in words]) == 2
    err = capsys.readouterr().err
    assert said in err and "internal error" not in err


def loaded_by(script: str) -> set[str]:
    """The modules that a process of its own has loaded when a script has ended."""
    ran = subprocess.run(
        [sys.executable, "-c", f"{script}\nimport sys\nprint(*sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    return set(ran.stdout.splitlines()[-1].split())


def test_a_robot_is_shown_without_what_data_and_files_need():
    loaded = loaded_by("from sambot_viz import Visualizer\nVisualizer(port=0).stop()")
    late = set("PIL sqlite3 rosbags".split())
    for name in ("sources.bag", "export", "meanings.foxglove", "sources.recorder"):
        late.add(f"sambot_viz.{name}")
    assert late & loaded == set()
    drawn = [name for name in loaded if name.startswith("sambot_viz.displays.data.")]
    assert len(drawn) < 10


def test_a_follower_is_started_without_what_a_robot_needs():
    script = "import sambot_viz.server.listener, sambot_viz.server.followers.follower"
    loaded = loaded_by(script)
    robot = ("robot", "rviz", "displays", "session", "topics", "publishing", "meshes")
    assert {"yaml", *(f"sambot_viz.{name}" for name in robot)} & loaded == set()


@pytest.mark.parametrize(
    "name", ["sam_bot.urdf.xacro", "sam_bot_collision.urdf.xacro", "mbot.urdf.xacro"]
)
def test_a_model_without_meshes_is_checked_without_numpy(name: str) -> None:
    model = str(bundled.model_path(name))
    loaded = loaded_by(f"from sambot_viz.cli import main\nmain(['check', {model!r}])\n")
    assert "sambot_viz.checks" in loaded
    assert "numpy" not in loaded


def test_a_drive_in_gazebo_is_checked_without_numpy(tmp_path: Path) -> None:
    wheel = '<visual><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" '
    wheel += 'length="0.04"/></geometry></visual>'
    text = '<link name="base_link"/>'
    for side, y in (("left", 0.2), ("right", -0.2)):
        text += f'<link name="{side}">{wheel}</link><joint name="{side}_joint" '
        text += f'type="continuous"><parent link="base_link"/><child link="{side}"/>'
        text += f'<origin xyz="0 {y} 0"/><axis xyz="0 1 0"/></joint>'
    text += '<gazebo><plugin filename="gz-sim-diff-drive-system" '
    text += 'name="gz::sim::systems::DiffDrive"><left_joint>left_joint</left_joint>'
    text += "<right_joint>right_joint</right_joint><wheel_radius>0.2</wheel_radius>"
    model = tmp_path / "r.urdf"
    model.write_text(f'<robot name="r">{text}</plugin></gazebo></robot>')
    loaded = loaded_by(
        "from sambot_viz import check\n"
        f"assert [p.code for p in check({str(model)!r})] == ['drive-wheel-radius']\n"
    )
    assert "numpy" not in loaded


def test_the_address_is_printed_before_session_and_panels_are_loaded() -> None:
    loaded = loaded_by(
        "from sambot_viz import outlet\n"
        "from sambot_viz.cli import main\n"
        "def write_out(url): raise KeyboardInterrupt\n"
        "outlet.write_out = write_out\n"
        "assert main(['--port', '0']) == 0"
    )
    own = {name for name in loaded if name.startswith("sambot_viz.")}
    # Of `panels` only the rows of pages, and how what they send is read.
    rooms = {"commands", "limits", "panels", "robot", "server", "viser_private"}
    assert {name.split(".")[1] for name in own if name.count(".") > 1} == rooms
    assert {"rich.console", "sambot_viz.panels.command", "yaml"} & loaded == set()
    assert len(own) < 75


def test_check_imports_only_what_a_small_model_needs(tmp_path: Path) -> None:
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    (tmp_path / "part.stl").write_bytes(bytes(80) + struct.pack("<I", 1) + facet)
    model = tmp_path / "r.urdf"
    visual = '<visual><geometry><mesh filename="part.stl"/></geometry></visual>'
    model.write_text(f'<robot name="r"><link name="a">{visual}</link></robot>')
    loaded = loaded_by(
        "from sambot_viz.cli import main\n"
        f"assert main(['check', {str(model)!r}]) == 0\n"
    )
    heavy = set("trimesh scipy networkx PIL yaml viser yourdfpy lxml secrets".split())
    heavy.update(f"sambot_viz.{name}" for name in ("frames", "topics", "displays"))
    late = ("child.exchange", "diagnose.source_files")
    heavy.update(f"sambot_viz.robot.xacro.{name}" for name in late)
    assert heavy & loaded == set()
