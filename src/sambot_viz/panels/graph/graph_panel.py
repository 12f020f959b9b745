"""The Graph panel of one browser: nodes and topics, placed for the page to draw."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePath
from typing import TYPE_CHECKING

from sambot_viz.panels.command import FLAG, command
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import (
    place_of,
    rows_by_place,
    without_folders,
)
from sambot_viz.panels.rows.row import Data, Json, LongText, Row
from sambot_viz.session.session_graph import SessionGraph
from sambot_viz.session.shown_problems import Problems

if TYPE_CHECKING:
    from sambot_viz.graph.placed_graph import PlacedGraph, PlacedPart


class GraphPanel(Panel):
    """What launch files would start, and what runs; made while the panel is seen.

    Args:
        graph: of the session.
        problems: their rows are where findings lead to.
        folders: whether places have whole paths.
    """

    name = "graph"

    def __init__(
        self, graph: SessionGraph, problems: Problems, folders: bool = True
    ) -> None:
        self.remade_by = (*graph.facts, graph.changed)
        self._graph = graph
        self._problems = problems
        self._folders = folders
        self._shown = False

    def rows(self) -> Sequence[Row]:
        """Return the choice of a launch file, and the facts about the graph."""
        return list(self._made()) if self._graph.is_there else ()

    def data(self) -> Sequence[Data]:
        """Return the picture, while the panel is on the screen."""
        placed = self._graph.placed if self._shown else None
        picture = None if placed is None else self._picture(placed)
        return [Data("graph/shown", self._shown), Data("graph/picture", picture)]

    def close(self) -> None:
        """Look at nothing more."""
        self._graph.follow(self, False)

    def _made(self) -> Iterator[Row]:
        names = [PurePath(name).name for name in self._graph.launches]
        if len(names) > 1:
            yield Row(
                "graph/launch",
                "",
                "enum",
                "Launch file",
                value=self._graph.launch or names[0],
                options=names,
                help="Draw what this launch file would start.",
                set=self._graph.choose,
            )
        placed = self._graph.placed if self._shown else None
        yield Row(
            "graph/details",
            "",
            "bool",
            "Details",
            value=self._graph.has_details,
            help="Draw types and packages, and topics that only one node has.",
            set=self._graph.draw_details,
        )
        if self._graph.is_waiting:
            said = "The robot is not connected: what runs is not known"
            yield Row("graph/robot", "", "note", value=said, level="info")
        elif placed is None:
            yield Row("graph/wait", "", "note", value="Reading the launch files …")
        elif not placed.parts:
            yield Row("graph/none", "", "note", value="No node and no topic is known")
        for number, note in enumerate(() if placed is None else placed.notes):
            said = note if self._folders else without_folders(note)
            yield Row(f"graph/note/{number}", "", "note", value=said, level="info")

    def _picture(self, placed: PlacedGraph) -> Json:
        rows = rows_by_place(self._problems.shown.value.listed)
        return {
            "width": placed.width,
            "height": placed.height,
            "spaces": [[s.x, s.y, s.width, s.height, s.name] for s in placed.spaces],
            "edges": [
                [LongText(edge.path), " ".join(edge.look), edge.said]
                for edge in placed.edges
            ],
            "parts": [self._part(part, rows) for part in placed.parts],
        }

    def _part(self, part: PlacedPart, rows: Mapping[str, str]) -> Json:
        said = part.said if self._folders else without_folders(part.said)
        row = "" if part.problem is None else rows.get(place_of(part.problem), "")
        return {
            "kind": part.kind,
            "name": part.name,
            "box": [part.x, part.y, part.width, part.height],
            "lines": [*part.lines],
            "look": " ".join(part.look),
            "said": said,
            "place": self._place(part),
            "problem": row,
        }

    def _place(self, part: PlacedPart) -> str:
        """Return the file and line that start a node, to be copied."""
        if not part.file:
            return ""
        path = Path(part.file)
        shown = str(path.absolute()) if self._folders else path.name
        return shown if part.line is None else f"{shown}:{part.line}"

    @command("graph/show", FLAG, client_local=True)
    def _show(self, shown: bool) -> None:
        """Make the graph, or do not: the panel is on the screen, or is not."""
        if self._shown != shown:
            self._shown = shown
            self._graph.follow(self, shown)
            self._graph.changed.touch()
