"""Files with a mistake from the start: shown by their problems until they are fixed."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from inside import signals_of
from patience import patience
from protocol_client import ProtocolClient

from sambot_viz import RobotError, Visualizer, bundled, load_robot
from sambot_viz.errors import Problem
from sambot_viz.inputs import Inputs
from sambot_viz.options import Options
from sambot_viz.server.sessions import Sessions
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
TWO = """<link name="hull"/>
<link name="arm"/>
"""
JOINT = """<joint name="j" type="continuous"><parent link="hull"/><child link="arm"/>
<axis xyz="0 0 1"/></joint>
"""
GOOD = f"{HEAD}{TWO}{JOINT}</robot>\n"
PARTS = f"{HEAD}{JOINT}</robot>\n"


class Shown:
    """A visualizer of files that may be broken, and waiting for what it does."""

    def __init__(self, inputs: Inputs, reports: list[tuple[Problem, ...]]) -> None:
        self.viz = Visualizer.of_inputs(inputs)
        self.reports = reports
        self._changed = threading.Condition(self.session.lock)
        connect(signals_of(self.session), self._hear)

    @property
    def session(self) -> Session:
        return self.viz.server.sessions.all()[0]

    def _hear(self) -> None:
        with self._changed:
            self._changed.notify_all()

    def wait_for(self, condition: Callable[[], object]) -> None:
        with self._changed:
            assert self._changed.wait_for(condition, patience(10.0))

    @property
    def codes(self) -> list[str]:
        return [problem.code for problem in self.session.problems.shown.value.listed]

    @property
    def config_codes(self) -> list[str]:
        return [code for code in self.codes if code.startswith("config")]


@contextmanager
def showing(model: Path, config: Path | None = None, **options: Any) -> Iterator[Shown]:
    reports: list[tuple[Problem, ...]] = []
    given = Options(
        model,
        config,
        watch=True,
        on_reload=lambda problems: reports.append(tuple(problems)),
        **options,
    )
    shown = Shown(Inputs(given, may_be_broken=True), reports)
    with shown.viz:
        yield shown


@pytest.mark.parametrize(
    ("broken", "code", "fix", "content"),
    [
        (GOOD.replace("</robot>", ""), "xml-root-not-closed", "r.xacro", GOOD),
        (
            GOOD.replace('"continuous"', '"hinge"'),
            "joint-type-unknown",
            "r.xacro",
            GOOD,
        ),
        (GOOD.replace(JOINT, ""), "root-not-unique", "r.xacro", GOOD),
        (
            GOOD.replace('"0 0 1"', '"0 0 ${one}"'),
            "xacro-undefined-name",
            "r.xacro",
            GOOD,
        ),
        (
            GOOD.replace(JOINT, '<xacro:include filename="parts/j.xacro"/>'),
            "xacro-include-missing",
            "parts/j.xacro",
            PARTS,
        ),
        (
            GOOD.replace(JOINT, '<xacro:include filename="$(find arms)/j.xacro"/>'),
            "xacro-package-not-found",
            "arms/j.xacro",
            PARTS,
        ),
        (
            GOOD.replace('"arm"', "\"${xacro.load_yaml('names.yaml')['arm']}\""),
            "xacro-include-missing",
            "names.yaml",
            "arm: arm\n",
        ),
    ],
)
def test_a_broken_model_is_shown_by_its_problem_and_by_its_robot_once_it_is_fixed(
    tmp_path: Path, broken: str, code: str, fix: str, content: str
) -> None:
    model = tmp_path / "r.xacro"
    model.write_text(broken)
    with showing(model, joint_positions={"j": 0.5}) as shown:
        assert code in shown.codes
        assert shown.session.robot.model is None
        assert (
            "The robot appears once it is fixed"
            in shown.session.problems.shown.value.note
        )

        (tmp_path / fix).parent.mkdir(exist_ok=True)
        (tmp_path / fix).write_text(content)

        shown.wait_for(lambda: shown.session.robot.model is not None)
        shown.wait_for(lambda: code not in shown.codes)
        assert shown.session.problems.shown.value.note == ""
        assert dict(shown.viz.joint_positions) == {"j": 0.5}
        assert shown.session.scene.context.fixed_frame == "hull"
        assert not shown.session.history.modified.value


def test_a_file_included_by_an_included_one_is_followed_before_the_first_robot(
    tmp_path: Path,
) -> None:
    def part(inside: str) -> str:
        return f"{HEAD}{inside}</robot>\n"

    model = tmp_path / "r.xacro"
    model.write_text(GOOD.replace(JOINT, '<xacro:include filename="a.xacro"/>${x}'))
    (tmp_path / "a.xacro").write_text(part('<xacro:include filename="b.xacro"/>'))
    (tmp_path / "b.xacro").write_text(part(JOINT))
    with showing(model) as shown:
        assert shown.codes == ["xacro-undefined-name"]
        prop = '<xacro:property name="x" value="1"/>'
        (tmp_path / "b.xacro").write_text(part(prop + JOINT))
        shown.wait_for(lambda: shown.session.robot.model is not None)


def test_the_broken_model_of_a_package_folder_is_followed(tmp_path: Path) -> None:
    package = tmp_path / "bot"
    (package / "urdf").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>bot</name></package>")
    model = package / "urdf" / "bot.urdf"
    model.write_text(GOOD.replace("</robot>", ""))
    with showing(package) as shown:
        assert shown.codes == ["xml-root-not-closed"]
        model.write_text(GOOD)
        shown.wait_for(lambda: shown.session.robot.model is not None)


def test_a_save_between_opening_and_following_is_not_missed(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(GOOD.replace(JOINT, ""))
    inputs = Inputs(Options(model, watch=True), may_be_broken=True)
    assert inputs.refusal() is not None
    model.write_text(GOOD)
    shown = Shown(inputs, [])
    with shown.viz:
        shown.wait_for(lambda: shown.session.robot.model is not None)


def test_what_is_wrong_is_reported_when_it_changes(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(GOOD.replace(JOINT, ""))
    with showing(model) as shown:
        model.write_text(GOOD.replace("</robot>", ""))
        shown.wait_for(lambda: shown.codes == ["xml-root-not-closed"])
        model.write_text(GOOD)
        shown.wait_for(lambda: shown.session.robot.model is not None)
        shown.viz.stop()
        codes = [[problem.code for problem in each] for each in shown.reports]
        assert codes == [["xml-root-not-closed"], []]


def test_a_start_position_that_does_not_fit_the_fixed_model_is_a_problem(
    tmp_path: Path,
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(GOOD.replace(JOINT, ""))
    with showing(model, joint_positions={"k": 0.5}) as shown:
        model.write_text(GOOD)
        shown.wait_for(lambda: shown.codes == ["start-position-refused"])
        model.write_text(GOOD.replace('"j"', '"k"'))
        shown.wait_for(lambda: shown.session.robot.model is not None)
        shown.wait_for(lambda: shown.codes == [])


def test_a_private_session_that_is_open_gets_the_robot_in_its_own_frame(
    tmp_path: Path, protocol: Callable[[int], ProtocolClient]
) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(GOOD.replace(JOINT, ""))
    options = Options(model, watch=True, session="private")
    with Visualizer.of_inputs(Inputs(options, may_be_broken=True)) as viz:
        client = protocol(viz.viser.get_port())
        client.wait_until(lambda: "no joint has it" in str(client.messages))
        model.write_text(GOOD)
        client.wait_until(lambda: client.types()["LabelMessage"] == 2)
        assert viz.server.sessions.all()[0].scene.context.fixed_frame == "hull"


def test_a_broken_config_gives_the_default_displays_and_cannot_be_written_over(
    tmp_path: Path,
) -> None:
    model, config = tmp_path / "r.urdf", tmp_path / "own.rviz"
    model.write_text(GOOD)
    config.write_text("{")
    with showing(model, config) as shown:
        session = shown.session
        assert shown.config_codes
        assert "Its displays appear once" in session.problems.shown.value.note
        assert len(session.scene.displays) == 3
        assert session.scene.context.fixed_frame == "hull"
        assert session.document.config.file == str(bundled.config_path())

        text = bundled.config_path().read_text()
        config.write_text(text.replace("base_link", "arm"))

        shown.wait_for(lambda: session.scene.context.fixed_frame == "arm")
        assert session.document.config.file == str(config)
        shown.wait_for(lambda: not shown.config_codes)


def test_what_was_changed_in_the_default_displays_is_kept(tmp_path: Path) -> None:
    model, config = tmp_path / "r.urdf", tmp_path / "own.rviz"
    model.write_text(GOOD)
    config.write_text("{")
    with showing(model, config) as shown:
        shown.session.document.set_option("Frame Rate", 12)
        config.write_text(bundled.config_path().read_text())
        shown.wait_for(lambda: "config-changes-kept" in shown.codes)
        assert shown.session.document.config.file == str(bundled.config_path())
        assert shown.session.document.config.global_options.get("Frame Rate") == 12


def test_both_files_may_be_broken(tmp_path: Path) -> None:
    model, config = tmp_path / "r.urdf", tmp_path / "own.rviz"
    model.write_text(GOOD.replace(JOINT, ""))
    config.write_text("{")
    with showing(model, config) as shown:
        model.write_text(GOOD)
        shown.wait_for(lambda: shown.session.robot.model is not None)
        assert shown.session.scene.context.fixed_frame == "hull"
        text = bundled.config_path().read_text()
        config.write_text(text.replace("base_link", "arm"))
        shown.wait_for(lambda: shown.session.scene.context.fixed_frame == "arm")
        shown.wait_for(lambda: not shown.config_codes)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes of a shell")
def test_a_model_from_a_pipe_cannot_be_fixed_and_is_refused(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_text, args=("<robot>",))
    writer.start()
    with pytest.raises(RobotError):
        Inputs(Options(pipe, watch=True), may_be_broken=True)
    writer.join()


def test_from_python_a_broken_model_is_an_error(tmp_path: Path) -> None:
    model = tmp_path / "r.urdf"
    model.write_text(GOOD.replace(JOINT, ""))
    with pytest.raises(RobotError):
        Visualizer(model, watch=True)


def test_a_robot_that_is_fixed_while_a_private_session_opens_is_checked_there(
    tmp_path: Path,
    protocol: Callable[..., ProtocolClient],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text(PARTS, "utf-8")
    open_session = Sessions.open

    def fixed_meanwhile(sessions: Sessions, *given: Any) -> Session:
        opened = open_session(sessions, *given)
        sessions.show_robot(load_robot(GOOD))
        return opened

    monkeypatch.setattr(Sessions, "open", fixed_meanwhile)
    inputs = Inputs(Options(model, session="private", port=0), may_be_broken=True)
    with Visualizer.of_inputs(inputs) as viz:
        client = protocol(viz.viser.get_port())
        client.wait_until(lambda: "problems/count" in client.rows)
        client.wait_until(lambda: not client.row("problems/count")["value"]["checking"])
        assert client.id_of("joints", "j")
