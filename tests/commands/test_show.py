"""`sambot-viz`: what it does with a model or a config that has a mistake."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from program import Serving, address, serving
from protocol_client import ProtocolClient

from sambot_viz.cli import main
from sambot_viz.commands import show

ARM = """<robot name="arm">
<link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="b"/>
<joint name="j" type="continuous"><parent link="a"/><child link="b"/></joint>
</robot>
"""
WITHOUT_JOINT = "\n".join(line for line in ARM.splitlines() if "<joint" not in line)
NOT_XML = ARM.replace("</robot>", "</rob>")
RVIZ = "Visualization Manager:\n  Displays: []\n"
BROKEN_RVIZ = "Panels:\n  - Class: a\n Name: b\n"


def read_until(program: Serving, text: str) -> str:
    """What standard error says up to a line with a text."""
    said = ""
    for line in program.stderr:
        said += line
        if text in line:
            return said
    raise AssertionError(f"it ended without {text!r}: {said}")


@pytest.mark.parametrize(
    ("broken", "code", "message"),
    [
        (NOT_XML, "xml-closing-tag-misspelt", "opened on line 1 is closed by"),
        (WITHOUT_JOINT, "root-not-unique", "there is more than one root link"),
    ],
)
def test_a_broken_model_is_served_and_its_robot_comes_when_it_is_fixed(
    tmp_path: Path,
    broken: str,
    code: str,
    message: str,
    protocol: Callable[..., ProtocolClient],
) -> None:
    model = tmp_path / "arm.urdf"
    model.write_text(broken)
    with serving("arm.urdf", "--port", "0", cwd=tmp_path) as program:
        client = protocol(int(address(program).rsplit(":", 1)[1]))
        said = read_until(program, "the page is open")
        assert said.startswith("arm.urdf:") and f"error[{code}]" in said
        client.wait_until(lambda: message in str(client.messages))
        assert client.types()["BoxMessage"] == 0

        model.write_text(ARM)

        assert read_until(program, "fixed") == "sambot-viz: all problems are fixed\n"
        client.wait_until(lambda: client.types()["BoxMessage"] == 1)
        assert program.end()[0] == 0


def test_a_broken_config_is_served_with_the_default_displays_until_it_is_fixed(
    tmp_path: Path,
) -> None:
    (tmp_path / "arm.urdf").write_text(ARM)
    config = tmp_path / "own.rviz"
    config.write_text(BROKEN_RVIZ)
    words = ("arm.urdf", "-d", "own.rviz", "--port", "0")
    with serving(*words, cwd=tmp_path) as program:
        assert address(program).startswith("http://")
        said = read_until(program, "the page is open")
        assert said.startswith("own.rviz:3:2: error[config-yaml]")
        config.write_text(RVIZ)
        assert read_until(program, "fixed") == "sambot-viz: all problems are fixed\n"


def test_a_problem_that_stays_is_written_once(tmp_path: Path) -> None:
    model, config = tmp_path / "arm.urdf", tmp_path / "own.rviz"
    model.write_text(ARM)
    config.write_text(BROKEN_RVIZ)
    words = ("arm.urdf", "-d", "own.rviz", "--port", "0")
    with serving(*words, cwd=tmp_path) as program:
        assert "error[config-yaml]" in read_until(program, "the page is open")
        model.write_text(NOT_XML)
        said = read_until(program, "error[xml-")
        model.write_text(ARM)
        said += read_until(program, "fixed; what is left is listed above")
        assert "config-yaml" not in said
        # Another mistake in it is news.
        config.write_text(f"# mine\n{BROKEN_RVIZ}")
        assert "own.rviz:4:2" in read_until(program, "error[config-yaml]")


@pytest.mark.parametrize(
    ("model", "config", "words", "said"),
    [
        (NOT_XML, RVIZ, ["--no-watch"], "arm.urdf:5:1: error"),
        (WITHOUT_JOINT, RVIZ, ["--no-watch"], "error[root-not-unique]"),
        (ARM, BROKEN_RVIZ, ["--no-watch"], "own.rviz:3:2: error"),
        (ARM, RVIZ, ["--joint", "k=1"], "no joint 'k'"),
        (ARM, RVIZ, ["--zeros", "k=1"], "no joint 'k'"),
        (ARM, RVIZ, ["--poses", "arm.urdf"], "arm.urdf"),
        (
            ARM,
            RVIZ,
            [f"--static-transform=0 0 0 0 0 0 {ends}" for ends in ("a b", "b a")],
            "the frames would form a ring",
        ),
    ],
)
def test_what_will_not_be_served_ends_with_1_and_without_an_address(
    model: str,
    config: str,
    words: list[str],
    said: str,
    tmp_path: Path,
) -> None:
    (tmp_path / "arm.urdf").write_text(model)
    (tmp_path / "own.rviz").write_text(config)
    words = ["arm.urdf", "-d", "own.rviz", "--port", "0", *words]
    with serving(*words, cwd=tmp_path) as program:
        code, out, err = program.end()
    assert (code, out) == (1, "")
    assert said in err


def test_a_presenter_gets_a_second_link_and_the_model_stays_the_model(
    tmp_path: Path, protocol: Callable[..., ProtocolClient]
) -> None:
    (tmp_path / "arm.urdf").write_text(ARM)
    with serving(
        "--presenter", "arm.urdf", "--port", "0", "--no-watch", cwd=tmp_path
    ) as program:
        (whose, link), (secrets, secret) = (
            program.stdout.readline().split() for _ in range(2)
        )
        assert (whose, secrets) == ("viewers:", "presenter:")
        page, _, query = secret.partition("/?present=")
        assert page == link and len(query) == 22
        port = int(link.rsplit(":", 1)[1])
        drives: list[bool] = []
        # Links that were noted down before say "token".
        for path in ("", f"/?present={query}", f"/?token={query}"):
            client = protocol(port, path=path)
            client.wait_until(lambda c=client: "role/me" in c.rows)
            drives.append(client.row("role/me")["value"]["control"])
        assert drives == [False, True, True]


def test_a_presenters_secret_of_ones_own_is_written_in_one_word(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(ARM)
    with serving(
        "--presenter=for-the-teacher", "arm.urdf", "--port", "0", cwd=tmp_path
    ) as program:
        assert address(program).startswith("http://127.0.0.1:")
        assert address(program).endswith("/?present=for-the-teacher")


def test_behind_a_proxy_the_links_that_browsers_can_open_are_printed_too(
    tmp_path: Path,
) -> None:
    (tmp_path / "arm.urdf").write_text(ARM)
    words = ["--token=for-the-class", "--presenter=for-the-teacher", "arm.urdf"]
    proxy = ["--allow-origin", "https://lab.example.org", "--base-path", "/robot"]
    with serving(*words, *proxy, "--port", "0", cwd=tmp_path) as program:
        assert address(program).startswith("http://127.0.0.1:")
        lines = [program.stderr.readline().strip() for _ in range(2)]
    page = "https://lab.example.org/robot/"
    assert lines == [
        f"sambot-viz: from other machines, viewers: {page}?view=for-the-class",
        f"sambot-viz: from other machines, presenter: {page}?present=for-the-teacher",
    ]


class Interrupted(threading.Event):
    """An event whose lock is held when Ctrl-C comes, as within `wait`."""

    def wait(self, timeout: float | None = None) -> bool:
        with self._cond:  # type: ignore[attr-defined]
            signal.raise_signal(signal.SIGINT)
        return super().wait(timeout)


def test_ctrl_c_ends_the_program_whatever_it_does_at_that_moment(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    model = tmp_path / "arm.urdf"
    model.write_text(ARM)
    names = {**vars(threading), "Event": Interrupted}
    monkeypatch.setattr(show, "threading", SimpleNamespace(**names))
    before = {n: signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM)}
    try:
        assert main([str(model), "--port", "0"]) == 0
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
