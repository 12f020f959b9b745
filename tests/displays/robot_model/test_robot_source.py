"""A RobotModel with a file of its own: what may be read, how, and by whom."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from patience import patience

from sambot_viz import Visualizer
from sambot_viz.displays.robot_display import ModelRequest
from sambot_viz.errors import RobotError, UsageError
from sambot_viz.inputs import declarations
from sambot_viz.options import Options
from sambot_viz.robot.model import Robot, load_robot
from sambot_viz.rviz import RvizConfig
from sambot_viz.server.model_thread import ModelThread
from sambot_viz.server.server import Server
from sambot_viz.session import Session
from sambot_viz.session.signals import connect

BALL = '<visual><geometry><sphere radius="1"/></geometry></visual>'
CODE = """
<robot name="second" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="${'run'.upper()}_link"/>
</robot>
"""
CONFIG = """
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Name: Second
      Enabled: true
      TF Prefix: b
{body}
  Global Options: {{Fixed Frame: base}}
"""
FROM_FILE = "      Description Source: File\n      Description File: {}"


def urdf(link: str) -> str:
    return f'<robot name="r"><link name="{link}">{BALL}</link></robot>'


class Case:
    """A session, and what its displays have asked to be read."""

    def __init__(self, session: Session, models: ModelThread) -> None:
        self.session, self.models = session, models
        self.display = session.scene.displays[0]

    def set(self, path: str, value: object) -> None:
        self.session.display_edits.set_property(self.display, path, value)
        assert self.models.wait(patience(20.0))

    def choose(self, file: Path | str) -> None:
        self.set("Description File", str(file))
        self.set("Description Source", "File")

    @property
    def status(self) -> str:
        return self.display.status.rows["URDF"].text


class Loader:
    """Reads models, and remembers what it was asked for."""

    def __init__(self) -> None:
        self.asked: list[tuple[Path, bool]] = []
        self.go_on = threading.Event()
        self.go_on.set()

    def __call__(self, path: Path, trusted: bool) -> Robot:
        assert self.go_on.wait(patience(20.0))
        self.asked.append((path, trusted))
        return load_robot(path, trusted=trusted)


@pytest.fixture
def loader() -> Loader:
    return Loader()


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """An opened package beside a file of somebody else."""
    folder = tmp_path / "pkg"
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>pkg</name></package>")
    (folder / "urdf" / "first.urdf").write_text(urdf("base"))
    (folder / "urdf" / "second.urdf").write_text(urdf("own"))
    (folder / "urdf" / "code.xacro").write_text(CODE)
    (folder / "secret.env").write_text("PASSWORD=hunter2 <a/>")
    (tmp_path / "foreign.urdf").write_text(urdf("foreign"))
    return folder


@pytest.fixture
def open_case(package: Path, loader: Loader) -> Iterator[Callable[..., Case]]:
    servers: list[Server] = []

    def opened(body: str = "") -> Case:
        document = RvizConfig.parse(CONFIG.format(body=body), declarations())
        models = ModelThread(loader)
        server = Server(Options(port=0, panels=False), lambda: document, models)
        servers.append(server)
        server.sessions.show_robot(load_robot(package / "urdf" / "first.urdf"))
        server.sessions.wait_for_meshes(patience(20))
        assert server.sessions.shared is not None
        return Case(server.sessions.shared, models)

    yield opened
    for server in servers:
        server.stop()


def test_a_file_of_the_opened_package_is_read_without_its_code(
    open_case: Callable[..., Case], loader: Loader, package: Path
) -> None:
    case = open_case()
    case.choose(package / "urdf" / "second.urdf")
    assert loader.asked == [(package / "urdf" / "second.urdf", False)]
    assert "b/own" in case.session.frames.tree.frames


@pytest.mark.parametrize(
    "name",
    [
        "{outside}/foreign.urdf",
        "{outside}/pkg/../foreign.urdf",
        "../foreign.urdf",
        "file://{outside}/foreign.urdf",
        "{outside}/pkg/link.urdf",
        "{outside}/pkg/nothing.urdf",
        "/etc/passwd",
        "/dev/zero",
        "~nobody_at_all/a.urdf",
        "a\0b",
        "x" * 300,
        "a/" * 499,
    ],
)
def test_a_browser_cannot_name_a_file_outside_and_learns_nothing(
    open_case: Callable[..., Case], loader: Loader, package: Path, name: str
) -> None:
    (package / "link.urdf").symlink_to(package.parent / "foreign.urdf")
    case = open_case()
    before = case.session.document.config.to_yaml()
    with pytest.raises(UsageError) as refused:
        case.set("Description File", name.format(outside=package.parent))
    # One sentence for a file that is elsewhere and one that is nowhere, without a path.
    said = "There is no such file in or below the folders that were opened: pkg, urdf"
    assert str(refused.value) == said
    assert case.session.document.config.to_yaml() == before
    assert case.display.status.rows["Description File"].text == said
    assert loader.asked == []


def test_a_folder_whose_name_begins_like_the_opened_one_is_outside(
    open_case: Callable[..., Case], package: Path
) -> None:
    other = package.parent / "pkg_of_others"
    other.mkdir()
    (other / "a.urdf").write_text(urdf("a"))
    with pytest.raises(UsageError):
        open_case().choose(other / "a.urdf")


def test_a_file_that_the_opened_config_names_is_trusted_wherever_it_lies(
    open_case: Callable[..., Case], loader: Loader, package: Path
) -> None:
    foreign = package.parent / "foreign.urdf"
    case = open_case(FROM_FILE.format(foreign))
    assert loader.asked == [(foreign, True)]
    assert "b/foreign" in case.session.frames.tree.frames
    case.choose(package / "urdf" / "second.urdf")
    case.choose(foreign)
    assert [trusted for _, trusted in loader.asked] == [True, False, True]


def test_a_copy_of_a_display_does_not_make_its_file_trusted(
    open_case: Callable[..., Case], loader: Loader, package: Path
) -> None:
    case = open_case()
    case.choose(package / "urdf" / "second.urdf")
    with case.session.change():
        case.session.document.config.duplicate(case.display.config)
        case.session.document.show()
    assert case.models.wait(patience(20.0))
    assert [trusted for _, trusted in loader.asked] == [False, False]


def test_code_of_a_file_that_a_browser_named_does_not_run(
    open_case: Callable[..., Case], package: Path
) -> None:
    code = package / "urdf" / "code.xacro"
    assert "b/RUN_link" in open_case(FROM_FILE.format(code)).session.frames.tree.frames
    case = open_case()
    case.choose(code)
    assert case.status == "URDF failed Model parse: see `sambot-viz check`"


def test_nothing_of_a_file_that_is_not_a_model_is_shown(
    open_case: Callable[..., Case], package: Path
) -> None:
    case = open_case()
    case.choose(package / "secret.env")
    assert "hunter2" not in str(case.display.status.rows)
    assert case.status.startswith("URDF failed Model parse")


def test_the_page_goes_on_while_a_model_is_being_read(
    open_case: Callable[..., Case], loader: Loader, package: Path
) -> None:
    case = open_case()
    loader.go_on.clear()
    case.session.display_edits.set_property(
        case.display, "Description File", str(package / "urdf" / "second.urdf")
    )
    case.session.display_edits.set_property(case.display, "Description Source", "File")
    assert case.status == "The model file is still being read"
    case.session.display_edits.set_property(case.display, "Alpha", 0.5)
    loader.go_on.set()
    assert case.models.wait(patience(20.0))
    assert case.display.status.rows["b/own"].level == "Error"  # No transform to base.
    assert case.status == "URDF parsed OK"


def test_only_the_latest_of_several_files_is_read(
    open_case: Callable[..., Case], loader: Loader, package: Path
) -> None:
    case = open_case(FROM_FILE.format(package / "urdf" / "first.urdf"))
    loader.asked.clear()
    loader.go_on.clear()
    for number in range(20):
        file = package / "urdf" / f"{number}.urdf"
        file.write_text(urdf(f"link_{number}"))
        case.session.display_edits.set_property(
            case.display, "Description File", str(file)
        )
    loader.go_on.set()
    assert case.models.wait(patience(20.0))
    assert len(loader.asked) <= 2
    assert "b/link_19" in case.session.frames.tree.frames


def test_a_reader_survives_an_internal_error_of_what_it_calls(tmp_path: Path) -> None:
    """One exception must not end all reading."""
    reader = ModelThread(lambda path, trusted: load_robot(path))
    failed: list[object] = []
    before, threading.excepthook = threading.excepthook, failed.append
    file = tmp_path / "a.urdf"
    file.write_text(urdf("a"))

    def broken(result: Robot | RobotError) -> None:
        raise RuntimeError("internal")

    results: list[Robot | RobotError] = []
    try:
        reader.read(ModelRequest(1, file, True, broken))
        assert reader.wait(patience(20.0))
        reader.read(ModelRequest(1, file, True, results.append))
        assert reader.wait(patience(20.0))
    finally:
        threading.excepthook = before
    assert isinstance(results[0], Robot)


def test_a_second_robot_follows_its_file(package: Path) -> None:
    second, config = package / "urdf" / "second.urdf", package / "a.rviz"
    config.write_text(CONFIG.format(body=FROM_FILE.format(second)))
    with Visualizer(package / "urdf" / "first.urdf", config, watch=True) as viz:
        session = viz._server.sessions.all()[0]
        drawn = threading.Event()

        def look() -> None:
            if "b/changed" in session.frames.tree.frames:
                drawn.set()

        viz._server.sessions.wait_for_meshes(patience(20))
        assert "b/own" in session.frames.tree.frames
        connect([session.scene.frames], look)
        second.write_text("<robot")
        second.write_text(urdf("changed"))
        assert drawn.wait(patience(20.0))
