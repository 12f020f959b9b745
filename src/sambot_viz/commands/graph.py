"""``sambot-viz graph``: nodes and topics, expected and running, as rqt_graph draws."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

from sambot_viz.bundled import missing
from sambot_viz.commands.command_line import (
    Parser,
    drawing_format,
    model_path,
    parse,
    write_drawing,
)
from sambot_viz.errors import SourceError, UsageError, did_you_mean
from sambot_viz.graph.drawing import graph_dot, graph_json_text
from sambot_viz.graph.node_graph import NodeGraph, compared
from sambot_viz.graph.svg import graph_svg
from sambot_viz.listened import CONNECTED_WITHIN
from sambot_viz.moved_by import open_moved_by, refuse_mixture, refuse_time_of_live
from sambot_viz.options import Options
from sambot_viz.outlet import write_err
from sambot_viz.text import text

if TYPE_CHECKING:
    from sambot_viz.graph.launches import StartedLaunch
    from sambot_viz.graph.running import RunningNodes
    from sambot_viz.topics.source_robot import SourceRobot

FORMATS = {".svg": "svg", ".dot": "dot", ".gv": "dot", ".json": "json"}
_QUIET = 0.5
"""Silence after which an answer that comes in pieces is complete [s]."""


def run(words: list[str]) -> int:
    """Draw the nodes of a package, of a robot, or of both; returns 0."""
    given, options = parse(parser(), words)
    output = None if given.output in (None, "-") else Path(given.output)
    how = given.format or ("dot" if output is None else drawing_format(output, FORMATS))
    if options.model is None and not options.sources:
        raise UsageError(
            "name a package with launch files, or --source URI of a robot, or both"
        )
    graphs: list[NodeGraph] = []
    if options.model is not None:
        graphs.append(_expected(options, given.launch))
    elif given.launch is not None:
        raise UsageError("--launch chooses a launch file of a package; name that too")
    if options.sources:
        graphs.append(_running(options, given.listen))
    graph = graphs[0] if len(graphs) == 1 else compared(*graphs)
    for note in graph.notes:
        write_err(f"sambot-viz: note: {text(note)}")
    drawn = _draw(graph, how, output)
    write_drawing(output, drawn)
    return 0


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz graph",
        groups=("model", "check", "source"),
        model="package folder, or a launch file",
        epilog="NAME:=VALUE is an argument of the launch file and of xacro, anywhere "
        "on the line, as for ros2 launch.",
        description="Draw nodes and topics from left to right, as rqt_graph does: what "
        "the launch files of a package would start, with what check finds in it, or "
        "what runs on a robot, as far as its bridge says it; with both, what was "
        "expected and does not run is marked. Launch files are read, not run. "
        "Exit status: 0 drawn, 1 no robot, 2 usage.",
    )
    made.add_argument(
        "--launch",
        metavar="NAME",
        help="the launch file to draw, where a package has several (default: the one "
        "that starts most)",
    )
    made.add_listen(what="how long a robot may take to say who publishes and reads")
    made.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="file to write: .svg, .dot or .json (default: DOT on standard output)",
    )
    made.add_argument(
        "--format",
        choices=("svg", "dot", "json"),
        help="what to write, instead of what the ending of FILE says",
    )
    return made


def _draw(graph: NodeGraph, how: str, output: Path | None) -> str:
    if how == "svg":
        return graph_svg(graph, None if output is None else output.parent)
    return graph_dot(graph) if how == "dot" else graph_json_text(graph)


def _expected(options: Options, name: str | None) -> NodeGraph:
    """Return what the launch files of the options' package would start."""
    from sambot_viz.checks.checked import check_all
    from sambot_viz.graph.expected import expected_graph
    from sambot_viz.graph.launches import started_launches

    path = model_path(options)
    assert path is not None
    if not path.exists():
        raise UsageError(missing("model", path))
    found = started_launches(
        path,
        arguments=options.xacro_args,
        package_path=options.package_path,
        workspace=options.workspace,
        trusted=options.trusted,
    )
    launch = _chosen(found, name, path)
    _note_unknown(options.xacro_args, launch.system.declared)
    try:
        problems = check_all(
            path if path.is_dir() else launch.package,
            xacro_args=options.xacro_args,
            package_path=options.package_path,
            workspace=options.workspace,
            trusted=options.trusted,
        ).problems
    except UsageError:
        # A package without a model can be drawn all the same.
        problems = ()
    return expected_graph(launch.system, problems)


def _note_unknown(given: Iterable[str], declared: frozenset[str]) -> None:
    """Report the arguments that no launch file declares; xacro may have them."""
    for name in given:
        if name not in declared:
            near = did_you_mean(name, sorted(declared))
            said = f"no launch argument '{text(name)}' is declared; {near}"
            write_err(f"sambot-viz: note: {said}")


def _chosen(
    found: Sequence[StartedLaunch], name: str | None, path: Path
) -> StartedLaunch:
    """Return the launch file to draw; the first one starts the most nodes.

    Raises:
        UsageError: there is none, or none of that name.
    """
    if not found:
        raise UsageError(f"'{path}' has no launch file that could be read")
    names = [one.name for one in found]
    if name is not None:
        chosen = next((one for one in found if one.is_called(name)), None)
        if chosen is None:
            known = [Path(one).name for one in names]
            near = did_you_mean(name, known, lambda one: one.split(".")[0])
            raise UsageError(f"no launch file '{name}'; {near}")
        return chosen
    if len(found) > 1:
        others = ", ".join(text(other) for other in names[1:])
        write_err(
            f"sambot-viz: note: drawn is {text(names[0])}, which starts most; "
            f"choose another with --launch: {others}"
        )
    return found[0]


def _running(options: Options, seconds: float) -> NodeGraph:
    """Return the nodes and topics that a robot reports.

    Raises:
        SourceError: there is no robot.
    """
    from sambot_viz.graph.running import RunningNodes

    refuse_time_of_live(options)
    refuse_mixture(options)
    robot = open_moved_by(options)
    assert robot is not None
    with closing(robot):
        changed = threading.Event()
        nodes = RunningNodes(robot.source, changed.set)
        if robot.source.live is not None:
            _listen(robot, nodes, changed, seconds)
        return nodes.graph()


def _listen(
    robot: SourceRobot, nodes: RunningNodes, changed: threading.Event, seconds: float
) -> None:
    """Connect, and wait until the robot has reported its publishers and subscribers.

    Raises:
        SourceError: there is no robot.
    """
    source = robot.source
    robot.on_topics.append(changed.set)
    robot.on_status.append(changed.set)
    source.open()
    if not _wait(changed, lambda: bool(source.topics()), CONNECTED_WITHIN):
        none = "; it has no topic" if source.status.is_connected else ""
        raise SourceError(f"{source.status.sentence}{none}")
    nodes.ask()
    end = time.monotonic() + seconds
    _wait(changed, lambda: nodes.is_known, seconds)
    while (left := end - time.monotonic()) > 0:
        before = nodes.graph()
        changed.wait(min(_QUIET, left))
        changed.clear()
        if nodes.graph() == before:
            break


def _wait(changed: threading.Event, is_so: Callable[[], bool], seconds: float) -> bool:
    """Wait for a condition, with a time limit [s]; return whether it became true."""
    end = time.monotonic() + seconds
    while not is_so():
        left = end - time.monotonic()
        if left <= 0:
            return False
        changed.wait(left)
        changed.clear()
    return True
