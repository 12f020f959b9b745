"""The rooms of the package: who may import whom, and where threads may be started.

A room is a folder of `src/sambot_viz`; the modules beside the folders are the hall.
Imports flow one way, from files to the page. When one of these tests fails, the import
is usually in the wrong room; a row of the table below is changed only on purpose.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

SCRIPTS = re.compile(r'^(?:import|export|\}) .*?"(\.[^"]+\.js)";', re.MULTILINE)
"""Finds the scripts that one of the page imports."""
FOUNDATIONS = {
    "advice",
    "cached",
    "content_policy",
    "edits",
    "errors",
    "extras",
    "files",
    "geometry",
    "limits",
    "matrices",
    "outlet",
    "text",
    "unsaved",
    "waiting",
}
"""Any room may import these; they import nothing of the package but each other."""

CONCURRENCY = {
    "_posixsubprocess",
    "_socket",
    "_thread",
    "asyncio",
    "concurrent",
    "ftplib",
    "http",
    "multiprocessing",
    "pty",
    "select",
    "selectors",
    "signal",
    "smtplib",
    "socket",
    "socketserver",
    "ssl",
    "subprocess",
    "threading",
    "urllib.request",
    "webbrowser",
    "xmlrpc",
}
"""Modules of the standard library with threads, processes, sockets or signals."""

QUIET = {
    "Condition",
    "Event",
    "Lock",
    "RLock",
    "Semaphore",
    "current_thread",
    "get_ident",
    "local",
    "main_thread",
}
"""Names of `threading` that start nothing; any room may use them."""

STARTERS = {"fork", "forkpty", "popen", "posix_spawn", "startfile", "system"}
"""Names of `os` that start a process; also all that begin with exec or spawn."""


@dataclass(frozen=True)
class Row:
    """What a room may import, beside the foundations and its own modules.

    Attributes:
        rooms: other rooms, and modules of the hall.
        packages: packages of others.
        concurrency: what of `CONCURRENCY` it may use.
    """

    rooms: str = ""
    packages: str = ""
    concurrency: str = ""


PURE = (
    "robot",
    "meshes",
    "checks",
    "rviz",
    "frames",
    "joints",
    "drive",
    "messages",
    "meanings",
    "topics",
    "graph",
    "lessons",
)
"""Rooms that work in a notebook or a grader: no viser, no socket, no thread."""

ROOMS: Mapping[str, Row] = {
    # From files to numbers.
    "meshes": Row("", "PIL lxml mapbox_earcut numpy trimesh"),
    "robot": Row("meshes", "numpy xacro yourdfpy"),
    "rviz": Row("", "PIL yaml re2"),
    "frames": Row("robot", "numpy"),
    "joints": Row("robot", "numpy yaml"),
    "drive": Row("joints robot", "numpy"),
    "messages": Row("", "google msgspec numpy rosbags"),
    # What they mean, whatever they are written in.
    "meanings": Row("messages", "numpy"),
    # From recordings and robots on the network to messages as bytes.
    "sources": Row(
        "_version messages",
        "cyclonedds lz4 mcap msgspec numpy requests websockets yaml zenoh zstandard",
    ),
    # What there is at a time, and why something is not seen.
    "topics": Row("frames joints meanings messages robot sources", "numpy"),
    # The way back to a robot.
    "publishing": Row("frames messages sources topics"),
    "checks": Row("bundled meshes robot rviz", "numpy yaml"),
    "graph": Row("checks robot sources"),
    "lessons": Row("bundled checks frames messages robot rviz sources topics", "yaml"),
    # From numbers to the scene.
    "viser_private": Row(
        "", "msgspec numpy rich viser websockets zstandard", "asyncio"
    ),
    "displays": Row(
        "frames meanings meshes robot rviz sources topics viser_private",
        "PIL numpy viser",
    ),
    "views": Row("rviz", "numpy"),
    "tools": Row("displays frames meshes publishing robot rviz views", "numpy viser"),
    "session": Row(
        "bundled checks displays drive fixes frames graph joints lessons meanings "
        "meshes options problems publishing robot rviz sources tools topics views "
        "viser_private",
        "PIL numpy viser",
        "asyncio concurrent",
    ),
    # From the scene to the page.
    "page": Row(),
    "panels": Row(
        "_version displays drive fixes frames graph joints lessons options page "
        "problems publishing robot rviz session tools topics views viser_private",
        "msgspec numpy viser",
    ),
    "server": Row(
        "_version displays explanations frames inputs joints meshes options page "
        "panels robot rviz session sources topics viser_private",
        "msgspec numpy prometheus_client segno viser watchfiles websockets zstandard",
        "asyncio concurrent http socket threading",
    ),
    "export": Row(
        "displays frames joints meshes page robot server session tools views "
        "viser_private",
        "PIL numpy viser websockets",
        "asyncio concurrent signal subprocess threading",
    ),
    # What programs and people start it with.
    "scripting": Row(
        "displays export frames joints options publishing robot rviz server session "
        "topics views",
        "numpy viser",
    ),
    # A program of one port, and those of the students behind it.
    "classroom": Row(
        "inputs lessons options page robot server session visualizer",
        "websockets",
        "asyncio http threading urllib.request",
    ),
    # Programs of their own, on other ports, and a page that leads to them.
    "lab": Row(
        "classroom options server sources",
        "websockets",
        "asyncio http",
    ),
    "commands": Row(
        "_version bundled checks classroom export fixes flags frames graph inputs "
        "explanations joints lab lessons listened moved_by options problems publishing "
        "robot rviz server session sources topics visualizer",
        "PIL",
        "signal threading webbrowser",
    ),
    "jupyter": Row("bundled cli flags options", "", "http signal socket ssl threading"),
    # The hall.
    "__init__": Row("_version checks frames inputs lessons robot rviz visualizer"),
    "__main__": Row("cli"),
    "_version": Row(),
    "advice": Row(),
    "bundled": Row("robot"),
    "cli": Row("problems"),
    "edits": Row(),
    "errors": Row(),
    "explanations": Row("bundled lessons"),
    "extras": Row(),
    "files": Row(),
    "fixes": Row(),
    "geometry": Row("", "numpy"),
    "inputs": Row(
        "bundled checks displays joints listened moved_by options robot rviz tools "
        "topics views",
        "yourdfpy",
        "concurrent threading",
    ),
    "cached": Row(),
    "content_policy": Row(),
    "flags": Row("frames joints"),
    "limits": Row(),
    "matrices": Row("", "numpy"),
    "listened": Row("sources topics", "", "threading"),
    "moved_by": Row("messages options rviz sources topics"),
    "options": Row(
        "flags frames joints lessons publishing robot rviz sources", "yourdfpy"
    ),
    "outlet": Row("", "segno"),
    "problems": Row(),
    "text": Row(),
    "unsaved": Row(),
    "waiting": Row(),
    "visualizer": Row(
        "export flags inputs jupyter options scripting server",
        "viser",
    ),
}

EXCEPTIONS: Mapping[str, str] = {
    # A live source has a thread for its connection and one that calls back.
    "sources/source.py": "concurrent",
    # Neither a session that hangs nor a page that floods may delay what stops a robot.
    "publishing/dead_mans_switch.py": "threading",
    # A recording has a thread that writes it.
    "sources/recording_thread.py": "threading",
    # What takes seconds must not hold the session's lock.
    "session/background.py": "threading",
    "sources/live/assets.py": "concurrent",
    "topics/live_files.py": "concurrent",  # files are asked for at once
    "sources/live/delivery.py": "threading",
    "sources/websocket/paced_connection.py": "socket",  # how its own is acknowledged
    "sources/websocket/runner.py": "asyncio",
    "sources/websocket/side_connection.py": "asyncio",
    "sources/live/event_loop.py": "asyncio socket threading",
    "sources/websocket/trouble.py": "socket ssl",
    "sources/live/live_source.py": "asyncio concurrent threading",
    "sources/websocket/websocket_source.py": "asyncio",
    "sources/follow/followed_recording.py": "asyncio",
    "sources/dds/dds_source.py": "asyncio",
    "sources/dds/ends.py": "asyncio",
    "sources/dds/participant.py": "asyncio threading",
    "sources/dds/services.py": "asyncio",
    "sources/zenoh/readings.py": "asyncio",
    "sources/zenoh/zenoh_source.py": "asyncio",
    "session/worker.py": "asyncio threading",  # each session has one worker thread
    # What ends a class ends its seats, in this order.
    "classroom/seats.py": "signal",
    # xacro and graders run in a child process.
    "robot/child_process.py": "signal subprocess",
    "robot/fork_server.py": "selectors socket subprocess",
    "robot/xacro/child/forks.py": "select signal socket subprocess",
    # In that child: the one thread of the pure rooms watches for the parent's end.
    "robot/xacro/child/main.py": "_thread signal",
}
"""Single files that may use more of `CONCURRENCY` than their room."""


@dataclass(frozen=True)
class Import:
    """One imported name, such as "sambot_viz.robot.load" or "threading.Lock".

    Attributes:
        name: module, and the name taken from it.
        typing: whether only type checkers see it.
    """

    name: str
    typing: bool


@cache
def source(repository: Path) -> Path:
    return repository / "src" / "sambot_viz"


def files_of(repository: Path, room: str) -> list[Path]:
    folder = source(repository) / room
    found = (
        sorted(folder.rglob("*.py")) if folder.is_dir() else [folder.with_suffix(".py")]
    )
    assert found, room
    return found


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text("utf-8"))


@cache
def imports(path: Path) -> tuple[Import, ...]:
    """Every import of a file, wherever in it, also those by name."""
    return tuple(_imports(tree_of(path), False))


def _imports(node: ast.AST, typing: bool) -> Iterator[Import]:
    if isinstance(node, ast.Import):
        yield from (Import(alias.name, typing) for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        assert node.level == 0, "imports are absolute"
        yield from (Import(f"{node.module}.{a.name}", typing) for a in node.names)
    elif isinstance(node, ast.Call) and _called(node) in (
        "import_module",
        "__import__",
    ):
        word = node.args[0]
        if isinstance(word, ast.Constant):
            yield Import(str(word.value), typing)
    if isinstance(node, ast.If) and _last_name(node.test) == "TYPE_CHECKING":
        for child in node.body:
            yield from _imports(child, True)
        for child in node.orelse:
            yield from _imports(child, typing)
    else:
        for child in ast.iter_child_nodes(node):
            yield from _imports(child, typing)


def _called(call: ast.Call) -> str:
    return _last_name(call.func)


def _last_name(node: ast.expr) -> str:
    if isinstance(node, ast.Attribute):
        return node.attr
    return node.id if isinstance(node, ast.Name) else ""


def concurrency(path: Path) -> set[str]:
    """What of `CONCURRENCY` a file uses; locks do not count."""
    used: set[str] = set()
    for each in imports(path):
        for module in CONCURRENCY:
            if each.name == module or each.name.startswith(f"{module}."):
                rest = each.name.removeprefix(module).lstrip(".")
                if module != "threading" or (rest and rest not in QUIET):
                    used.add(module)
        if each.name.startswith("os.") and _starts_a_process(each.name[3:]):
            used.add("subprocess")
    names = {each.asname or each.name: each.name for each in _plain_imports(path)}
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            module = names.get(node.value.id)
            if module == "threading" and node.attr not in QUIET:
                used.add("threading")
            if module == "os" and _starts_a_process(node.attr):
                used.add("subprocess")
    return used


def _plain_imports(path: Path) -> Iterator[ast.alias]:
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.Import):
            yield from node.names


def _starts_a_process(name: str) -> bool:
    return name in STARTERS or name.startswith(("exec", "spawn"))


def test_every_room_and_every_module_of_the_hall_has_a_row(repository: Path) -> None:
    folder = source(repository)
    there = {path.stem for path in folder.glob("*.py")}
    there |= {path.parent.name for path in folder.glob("*/__init__.py")}
    assert set(ROOMS) == there


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_what_its_row_allows(repository: Path, room: str) -> None:
    row = ROOMS[room]
    allowed = {*FOUNDATIONS, room, *row.rooms.split()}
    packages = {*row.packages.split(), *sys.stdlib_module_names, "typing_extensions"}
    for path in files_of(repository, room):
        for each in imports(path):
            package, _, rest = each.name.partition(".")
            if package == "sambot_viz":
                met = rest.split(".")[0]
                assert met in allowed, f"{path} imports {each.name}"
            else:
                assert package in packages, f"{path} imports {each.name}"
            if package == "typing_extensions":
                assert each.typing, f"{path} needs {package} when it runs"


@pytest.mark.parametrize("room", ROOMS)
def test_threads_sockets_and_processes_are_only_where_a_row_allows_them(
    repository: Path, room: str
) -> None:
    for path in files_of(repository, room):
        name = path.relative_to(source(repository)).as_posix()
        allowed = {*ROOMS[room].concurrency.split(), *EXCEPTIONS.get(name, "").split()}
        assert concurrency(path) <= allowed, name


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("import threading\nthreading.Thread()", {"threading"}),
        ("import threading as t\nt.Timer(1, print)", {"threading"}),
        ("from threading import Thread as T", {"threading"}),
        ("import threading\nlock = threading.RLock()", set[str]()),
        ("from threading import Lock", set[str]()),
        ("def f():\n    import _thread", {"_thread"}),
        ("from concurrent.futures import ThreadPoolExecutor", {"concurrent"}),
        ("import importlib\nimportlib.import_module('socket')", {"socket"}),
        ("from urllib import request", {"urllib.request"}),
        ("from urllib.parse import quote", set[str]()),
        ("import os\nos.fork()", {"subprocess"}),
        ("from os import execv", {"subprocess"}),
        ("import asyncio.events", {"asyncio"}),
    ],
)
def test_a_thread_is_found_however_it_is_started(
    text: str, found: set[str], tmp_path: Path
) -> None:
    path = tmp_path / "module.py"
    path.write_text(text)
    assert concurrency(path) == found


def test_the_table_of_rooms_is_tight(repository: Path) -> None:
    """A pure room may use nothing, and a row allows no concurrency that is unused."""
    for room in PURE:
        assert not ROOMS[room].concurrency
        assert "viser" not in ROOMS[room].packages.split()
    for name, used in EXCEPTIONS.items():
        assert concurrency(source(repository) / name) == {*used.split()}, name


def test_the_pure_rooms_load_no_viewer_and_start_no_thread(repository: Path) -> None:
    modules = [
        ".".join(path.relative_to(source(repository).parent).with_suffix("").parts)
        for room in PURE
        for path in files_of(repository, room)
        if "child" not in path.parts
    ]
    script = (
        "import importlib, sys, threading\n"
        f"for name in {modules!r}:\n"
        "    importlib.import_module(name.removesuffix('.__init__'))\n"
        "from sambot_viz import bundled, check, load_robot\n"
        "robot = load_robot(bundled.model_path())\n"
        "robot.forward_kinematics()\n"
        "check(bundled.model_path())\n"
        "assert threading.active_count() == 1, threading.enumerate()\n"
        "heavy = {'viser', 'websockets', 'watchfiles', 'asyncio', 'rosbags'}\n"
        "heavy &= set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], check=False, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr


def test_no_two_folders_import_each_other(repository: Path) -> None:
    """Also in a ring of several, at every level; types do not count."""
    root = source(repository)
    for folder in {path.parent for path in root.rglob("*.py")}:
        above = ".".join(folder.relative_to(root.parent).parts)
        assert list(rings(neighbours(folder, above))) == [], folder


def test_no_two_modules_import_each_other(repository: Path) -> None:
    """Also in a ring of several, and for type checkers only: there is one way."""
    root = source(repository)
    paths = {
        ".".join(path.relative_to(root.parent).with_suffix("").parts): path
        for path in root.rglob("*.py")
    }
    paths = {name.removesuffix(".__init__"): path for name, path in paths.items()}
    graph = {
        name: {
            each.name if each.name in paths else each.name.rpartition(".")[0]
            for each in imports(path)
        }
        for name, path in paths.items()
    }
    graph = {name: met & (paths.keys() - {name}) for name, met in graph.items()}
    assert list(rings(graph)) == []


def test_no_two_scripts_of_the_page_import_each_other(repository: Path) -> None:
    page = (source(repository) / "page").resolve()
    graph = {
        path: {
            (path.parent / name).resolve()
            for name in SCRIPTS.findall(path.read_text("utf-8"))
        }
        for path in page.rglob("*.js")
    }
    assert sum(map(len, graph.values())) > len(graph) > 50
    names = {
        path: {str(one) for one in met if one in graph} for path, met in graph.items()
    }
    assert list(rings({str(path): met for path, met in names.items()})) == []


HOLDERS = {
    "export/recorded_scene.py",
    "panels/browser.py",
    "panels/window.py",
    "scripting/camera_control.py",
    "scripting/displays.py",
    "scripting/events.py",
    "scripting/link_control.py",
    "scripting/outputs.py",
    "scripting/player_control.py",
    "server/client_sessions.py",
    "server/recordings.py",
    "server/reload.py",
    "server/sessions.py",
    "session/__init__.py",
}
"""Modules that may name `Session`: they build one, find that of a client or make its
panels; what a program does is done in all of them. All others get the parts that they
use."""


def test_only_few_modules_take_a_whole_session(repository: Path) -> None:
    """Also for type checkers only; a module that no longer does leaves the list."""
    root, session = source(repository), "sambot_viz.session"
    found = {
        path.relative_to(root).as_posix()
        for path in root.rglob("*.py")
        for each in imports(path)
        if each.name in (f"{session}.Session", f"{session}.session.Session")
    }
    assert found == HOLDERS


def neighbours(folder: Path, above: str) -> dict[str, set[str]]:
    """Module or folder in a folder → those beside it that it imports."""
    known: dict[str, set[str]] = {}
    for path in folder.rglob("*.py"):
        parts = path.relative_to(folder).with_suffix("").parts
        if parts[0] == "__init__":
            continue
        known.setdefault(parts[0], set()).update(
            each.name.removeprefix(f"{above}.").split(".")[0]
            for each in imports(path)
            if not each.typing and each.name.startswith(f"{above}.")
        )
    return {name: met & (known.keys() - {name}) for name, met in known.items()}


def rings(graph: Mapping[str, set[str]]) -> Iterator[set[str]]:
    """The groups of nodes of a graph that reach each other."""

    def reached(start: str) -> set[str]:
        found: set[str] = set()
        pending = [start]
        while pending:
            new = graph[pending.pop()] - found
            found |= new
            pending += new
        return found

    reach = {name: reached(name) for name in graph}
    done: set[str] = set()
    for name in graph:
        if name in reach[name] and name not in done:
            ring = {other for other in reach[name] if name in reach[other]}
            done |= ring
            yield ring


@pytest.mark.parametrize(
    "words",
    [
        ["--help"],
        ["--version"],
        ["check", "--help"],
        ["check", "MODEL"],
        ["expand", "MODEL"],
        ["echo", "MODEL", "base_link", "front_caster"],
        ["frames", "MODEL"],
        ["grade", "MODEL", "--lesson", "LESSON"],
        ["graph", "MODEL"],
        ["topics", "RECORDING"],
    ],
)
def test_a_light_command_imports_neither_viser_nor_a_mesh_library(
    repository: Path, words: list[str]
) -> None:
    model = str(repository / "assets" / "sam_bot.urdf.xacro")
    recording = str(repository / "assets" / "square.mcap")
    lesson = str(repository / "tests" / "data" / "lessons" / "base")
    named = {"MODEL": model, "RECORDING": recording, "LESSON": lesson}
    words = [named.get(word, word) for word in words]
    # To decode messages is what it is for.
    known = {"rosbags"} if words[0] == "topics" else set[str]()
    script = (
        "import sys\n"
        "from sambot_viz.cli import main\n"
        "try:\n"
        f"    main({words!r})\n"
        "except SystemExit:\n"
        "    pass\n"
        "heavy = {'viser', 'trimesh', 'yourdfpy', 'scipy', 'PIL', 'rosbags', "
        "'google.protobuf'}\n"
        f"heavy -= {known!r}\n"
        "heavy &= set(sys.modules)\n"
        "assert not heavy, heavy\n"
    )
    subprocess.run([sys.executable, "-c", script], check=True, capture_output=True)


PUBLIC_NAMES = [
    "ConfigError",
    "FrameError",
    "Grade",
    "Joint",
    "JointError",
    "LessonError",
    "Link",
    "Problem",
    "Robot",
    "RobotError",
    "RvizConfig",
    "SambotVizError",
    "ServerError",
    "Transform",
    "UsageError",
    "Visualizer",
    "__version__",
    "check",
    "grade",
    "load_config",
    "load_robot",
]
"""A name here is a promise to users' scripts: none is taken away or renamed."""


def test_the_public_names_are_those_that_users_know() -> None:
    import sambot_viz

    assert sambot_viz.__all__ == PUBLIC_NAMES
    assert dir(sambot_viz) == PUBLIC_NAMES
    source = ast.parse(Path(sambot_viz.__file__ or "").read_text("utf-8"))
    imports = [node for node in ast.walk(source) if isinstance(node, ast.ImportFrom)]
    seen = {name.asname for node in imports for name in node.names if name.asname}
    assert seen == set(PUBLIC_NAMES)
    for name in PUBLIC_NAMES:
        assert getattr(sambot_viz, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'Robto'"):
        _ = sambot_viz.Robto


def test_a_class_name_has_one_meaning_in_the_package(repository: Path) -> None:
    seen: dict[str, Path] = {}
    for path in sorted((repository / "src" / "sambot_viz").rglob("*.py")):
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.ClassDef):
                other = seen.setdefault(node.name, path)
                assert other == path, f"{node.name}: {other} and {path}"
