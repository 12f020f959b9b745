"""The Compare panel: what the robot is compared with, and what differs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from sambot_viz import limits
from sambot_viz.frames.hierarchy import plain_name
from sambot_viz.panels.panel import Panel
from sambot_viz.panels.problems.problems_panel import place_of_line
from sambot_viz.panels.rows.row import Data, Json, Level, Row
from sambot_viz.robot.difference import Difference
from sambot_viz.robot.difference_words import in_words
from sambot_viz.session.comparison import Compared, Comparison
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.text import text

_LONGEST_NAME = 60
_NONE, _SAVED = "Nothing", "The saved text"
_WITH = (
    "The text of the model that was saved last, or the model of --reference. What "
    "differs is drawn as a ghost and listed below."
)


class ComparePanel(Panel):
    """The choice of a model, the look of its ghost, and a table of the differences.

    Args:
        comparison: the comparison of the session.
        robot: the shown robot.
        scene: the scene with the nodes of its links.
        has_text: whether the text of the model can be changed.
    """

    name = "compare"

    def __init__(
        self, comparison: Comparison, robot: RobotState, scene: Scene, has_text: bool
    ) -> None:
        self.remade_by = (comparison.changed,)
        self._comparison, self._robot = comparison, robot
        self._context = scene.context
        self._has_text = has_text

    def rows(self) -> Sequence[Row]:
        """Return the choice, and the look of the ghost."""
        names, choice = self._names(), self._comparison.choice
        if len(names) == 1:
            return []
        rows = [
            Row(
                "compare/with",
                "",
                "enum",
                "Compare with",
                names.get(choice.compared, _NONE),
                options=tuple(names.values()),
                help=_WITH,
                set=self._choose,
            )
        ]
        if choice.compared != "none":
            rows += [
                Row(
                    "compare/ghost",
                    "",
                    "bool",
                    "Ghost",
                    choice.ghost,
                    help="Draw the links that differ, as they are in the other model; "
                    "those inside of the robot need a lower Alpha of RobotModel.",
                    set=self._setter("ghost"),
                ),
                Row(
                    "compare/alpha",
                    "",
                    "float",
                    "Alpha",
                    choice.alpha,
                    least=0.05,
                    most=1.0,
                    step=0.05,
                    help="How opaque the ghost is.",
                    set=self._setter("alpha"),
                ),
            ]
        said, level = self._note()
        rows.append(Row("compare/note", "", "note", value=said, level=level))
        return rows

    def data(self) -> Sequence[Data]:
        """Return what differs, and where that is."""
        found = self._comparison.found or ()
        most = limits.COMPARE_ROWS.value
        return [Data("compare/found", [self._difference(one) for one in found[:most]])]

    def _note(self) -> tuple[str, Level | None]:
        found, compared = self._comparison.found, self._comparison.choice.compared
        if compared == "none":
            return "Choose a model to see what differs from it.", None
        if compared == "reference" and not self._comparison.reference:
            return "The reference is being read…", None
        if self._comparison.other is None:
            return "The other model cannot be read: see Problems.", "warn"
        if self._robot.model is None:
            return "There is no robot yet.", None
        if found is None:
            return "Comparing…", None
        if not found:
            return "The models are the same.", "ok"
        left_out = len(found) - limits.COMPARE_ROWS.value
        more = f"; the first {limits.COMPARE_ROWS.value} are listed"
        said = f"{len(found)} difference{'s' if len(found) > 1 else ''}"
        return f"{said}{more if left_out > 0 else ''}", None

    def _difference(self, found: Difference) -> Json:
        link = self._link_of(found)
        own = self._robot.model is not None and link in self._robot.model.links
        return {
            **in_words(found)._asdict(),
            "places": _places(found),
            "link": link if own else "",
            "node": self._node(link),
        }

    def _link_of(self, found: Difference) -> str:
        """Return the link of a row; for a joint its child link."""
        if found.kind != "joint":
            return found.name
        models = (self._robot.model, self._comparison.other)
        joints = (model.joints.get(found.name) for model in models if model)
        return next((joint.child for joint in joints if joint is not None), "")

    def _node(self, link: str) -> str:
        """Return the last part of the name of a link's node, or of its ghost's."""
        frame = self._context.only_meant(plain_name(link))
        path = self._context.nodes.path(frame) or self._comparison.ghost.path(link)
        return (path or "").rpartition("/")[2]

    def _names(self) -> Mapping[Compared, str]:
        """Return what can be chosen, as users call it."""
        names: dict[Compared, str] = {"none": _NONE}
        if self._has_text:
            names["saved"] = _SAVED
        if self._comparison.reference:
            name = text(self._comparison.reference, _LONGEST_NAME)
            names["reference"] = f"Reference {name}"
        return names

    def _choose(self, name: str) -> None:
        compared = next(key for key, said in self._names().items() if said == name)
        choice = self._comparison.choice
        self._comparison.choose(replace(choice, compared=compared))

    def _setter(self, field: str) -> Callable[[bool | float], None]:
        def take(value: bool | float) -> None:
            choice = self._comparison.choice
            self._comparison.choose(replace(choice, **{field: value}))

        return take


def _places(found: Difference) -> str:
    """Say where the two values are written."""
    both = zip(("Mine", "Theirs"), found.places, strict=True)
    said = (f"{whose}: {place_of_line(p.file, p.line)}" for whose, p in both if p)
    return ", ".join(said)
