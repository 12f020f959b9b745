"""The problems that a session shows: of its model, of saves, and of the program.

The rules run after the robot is drawn, so that the picture never waits for them. What
they find joins what was found while loading.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, NamedTuple

from sambot_viz import limits
from sambot_viz.displays.display import Display, robot_displays
from sambot_viz.errors import Edit, Problem, SambotVizError
from sambot_viz.meshes.asset import Asset
from sambot_viz.meshes.mesh import Mesh
from sambot_viz.problems import in_order
from sambot_viz.robot.model import Robot
from sambot_viz.rviz.not_here import tools_not_here
from sambot_viz.session.data.session_sources import SessionSources
from sambot_viz.session.document.document import ShownDocument
from sambot_viz.session.robot.robot_state import RobotState
from sambot_viz.session.scene.scene import Scene
from sambot_viz.session.signals import Change, Signal, connect
from sambot_viz.session.worker import log_error
from sambot_viz.topics.reasons import TopicReason
from sambot_viz.unsaved import unsaved

Reloaded = Literal["model", "config", "watch", "fault", "description", "reference"]
"""What a save concerned (model, config, reference), or a cause that all share."""
_OTHERS: Sequence[Reloaded] = ("fault", "watch", "reference")


@dataclass(frozen=True, slots=True)
class ShownProblems:
    """The problems as a page shows them.

    Attributes:
        listed: the problems without repetitions, errors first, then in the order of the
            files.
        note: names what the page shows while the files have a mistake; "" if they have
            none.
        checking: whether the rules still have to run for this model.
    """

    listed: tuple[Problem, ...] = ()
    note: str = ""
    checking: bool = False


class Problems:
    """Collects the problems of one session.

    Args:
        document: the config, which has problems too.
        scene: its displays report problems of their files.
        robot: the robot that stays on show while a save has a mistake.
        sources: their problems, and those of the played messages.
        notes: findings that are always listed.
        fixes: whether problems keep their edits; a lesson may hide them from students.

    Attributes:
        shown: the list for pages.
        of_model: the problems of the shown model.
        of_frames: the problems of its frames and wheels; `set_model` adds them.
        of_saves: the problems because of which the last save is not shown.
        of_text: the problems because of which the text in the editor is not shown; None
            while it equals the files.
        saves: emitted when these two change.
        tell_client: called with a client and a notice for it alone.
    """

    def __init__(
        self,
        document: ShownDocument,
        scene: Scene,
        robot: RobotState,
        change: Change,
        sources: SessionSources,
        notes: Sequence[Problem] = (),
        fixes: bool = True,
    ) -> None:
        self._notes, self._fixes = tuple(notes), fixes
        self.shown = Signal(change, ShownProblems())
        self.of_model: tuple[Problem, ...] = ()
        self.of_frames: tuple[Problem, ...] = ()
        self.of_saves: dict[Reloaded, tuple[Problem, ...]] = {}
        self.of_text: tuple[Problem, ...] | None = None
        self.tell_client: Callable[[int, str], None] = lambda client, text: None
        self._checking = False
        # Applied since the model was read: what they mend is gone, whatever else the
        # text has now.
        self._applied: frozenset[Edit] = frozenset()
        self._document = document
        self._scene = scene
        self._robot = robot
        self._change = change
        self._logged: set[Problem] = set()
        self.saves = Signal(change, None)
        self._model = Signal(change, None)
        self._sources = sources
        facts = [document.replaced, scene.statuses, robot.changed, sources.problems]
        connect([*facts, self.saves, self._model], self._show)

    def set_model(self, problems: Sequence[Problem], *, checking: bool = False) -> None:
        """Show the problems of the model.

        Args:
            problems: all that are known.
            checking: whether the rules will run, and may find more.
        """
        with self._change.lock:
            self._checking, self._applied = checking, frozenset[Edit]()
            notes = (*self._notes, *self._sources.notes)
            self.of_model = (*notes, *problems, *self.of_frames)
            self._model.touch()

    def note_applied(self, edits: Iterable[Edit]) -> None:
        """List no more what edits have mended, until the model is read again."""
        with self._change(self.saves):
            self._applied = self._applied.union(edits)

    def set_saves(self, of: Reloaded, problems: Sequence[Problem]) -> None:
        """Set the problems that keep the last save from being shown; [] if it is."""
        if self.of_saves.get(of, ()) != tuple(problems):
            with self._change(self.saves):
                self.of_saves[of] = tuple(problems)

    def set_text(self, problems: Sequence[Problem] | None) -> None:
        """Set the problems that keep the text in the editor from being shown.

        Args:
            problems: its problems; empty when it is shown, None when it equals the
                files.
        """
        found = None if problems is None else tuple(problems)
        if self.of_text != found:
            with self._change(self.saves):
                self.of_text = found

    @property
    def of_newest(self) -> tuple[Problem, ...]:
        """Why the newest text of the model, in the editor or saved, is not shown."""
        of_file = self.of_saves.get("model", ())
        if self.of_text is None:
            return of_file
        # The editor keeps the text of a file that is gone, and the robot is that of it.
        gone = (problem for problem in of_file if problem.code == "model-not-found")
        return (*gone, *self.of_text)

    def report_error(self, error: Exception, client: int | None = None) -> None:
        """Show an exception that was not handled, and log it once.

        Args:
            error: the exception.
            client: the client that caused it, the only one to get it; None for all.
        """
        if isinstance(error, SambotVizError):
            problem = Problem("error", "refused", str(error))
        else:
            text = f"internal error: {type(error).__name__}: {error}"
            hint = "start the program again, and please report it"
            problem = Problem("error", "internal-error", text, hint)
        with self._change.lock:
            # A client may cause as many as it likes.
            known = problem in self._logged or len(self._logged) >= limits.LOGGED.value
            if problem.code == "internal-error" and not known:
                log_error(error)
                self._logged.add(problem)
            if client is None:
                self.set_saves("fault", (problem,))
            else:
                self.tell_client(client, problem.message)

    def _show(self) -> None:
        self.shown.set(
            ShownProblems(tuple(self._listed()), self._note(), self._checking)
        )

    def _listed(self) -> list[Problem]:
        """List the problems to show.

        While a saved file has a mistake, the problems of the shown version stay listed,
        except those whose edits were applied. A problem of both versions is listed
        once, at its place in the saved file.
        """
        saved = self.of_saves
        shapes = (p for d in robot_displays(self._scene.displays) for p in d.problems)
        known = (
            p for p in self.of_model if not p.edits or self._applied.isdisjoint(p.edits)
        )
        model = _also(self.of_newest, (*known, *shapes))
        shown = self._document.config
        of_config = (*shown.problems, *tools_not_here(shown))
        config = _also(saved.get("config", ()), of_config)
        others = [p for of in _OTHERS for p in saved.get(of, ())]
        played = [*self._sources.problems.value]
        played += problems_of_topics(self._scene.displays)
        found = in_order((*_also(model, played), *config, *others))
        return found if self._fixes else [replace(one, edits=()) for one in found]

    def _note(self) -> str:
        notes: list[str] = []
        if _is_error(self.of_newest):
            notes.append(
                "The model has an error. The robot appears once it is fixed."
                if self._robot.model is None
                else f"{self._what_is_wrong()}; showing the last version that worked."
            )
        if _is_error(self.of_saves.get("config", ())):
            notes.append(
                "The config has an error. Its displays appear once it is fixed."
            )
        return " ".join(notes)

    def _what_is_wrong(self) -> str:
        """Return a sentence about the model's file, or about a live robot's model."""
        for fault in self.of_newest:
            if fault.code == "model-not-found" and fault.file is not None:
                return f"{Path(fault.file).name} is gone"
            if fault.file is not None and "://" in fault.file:
                return "The new description has an error"
        return f"Your {'file' if self.of_text is None else 'text'} has an error"


def _is_error(problems: Iterable[Problem]) -> bool:
    return any(problem.severity == "error" for problem in problems)


def problems_of_topics(displays: Iterable[Display]) -> Iterator[Problem]:
    """Yield why topics that displays are asked to show are not seen, each once.

    Args:
        displays: of a scene.
    """
    told: set[tuple[str, TopicReason]] = set()
    for display in displays:
        for topic, why in display.unseen_topics() if display.shown else ():
            if why.severity == "info" or (topic, why) in told:
                continue
            told.add((topic, why))
            name = topic or f"the display {display.config.name}"
            yield Problem(why.severity, why.code, f"{name}: {why.text}")


class _State(NamedTuple):
    """What the rules look at: a robot, how much is known of its meshes, and saves."""

    robot: int
    read_count: int
    saves: int


class Checks:
    """Keeps the problems that the rules find up to date.

    Attributes:
        files: the files around the model that the rules have looked for.
        texts: whole path of a file → its text in the editor, where that is not saved;
            change it with the session locked.
        moved: numbers of the model that are another one there; see `ModelNumbers`.
    """

    def __init__(
        self,
        robot: RobotState,
        document: ShownDocument,
        scene: Scene,
        problems: Problems,
        change: Change,
        workspace: Sequence[Path | str] = (),
    ) -> None:
        self._workspace = tuple(workspace)
        self._robot = robot
        self._document = document
        self._context = scene.context
        self._problems = problems
        self._change = change
        self._of_robot: tuple[Problem, ...] = ()
        self._of_files: tuple[Robot | None, int, tuple[Problem, ...]] = (None, 0, ())
        self._saves = 0
        self.texts: Mapping[str, str] = {}
        self.moved: Mapping[str, float] = {}
        self.files: Signal[frozenset[Path]] = Signal(change, frozenset())
        self._checked: _State | None = None
        self._asked: tuple[object, bool] = (None, False)
        facts = [document.replaced, document.options, document.displays]
        connect([*facts, scene.frames, scene.statuses], self._follow)

    def run(self) -> None:
        """Check the shown model and config; the robot only if it may have changed."""
        with self._change.lock:
            robot, joints = self._robot.model, self._robot.joints
            if robot is None or joints is None:
                return
            before, state, texts = self._checked, self._state(), self.texts
            self._checked = state
            of_joints, of_config = joints.problems, self._of_config(robot)
            frame, file = self._context.fixed_frame, self._document.config.file
        with unsaved(texts):
            of_config = self._without_published(of_config, robot, frame, file)
            of_robot = self._of_rules(robot, state) if before != state else None
        with self._change.lock:
            if self._checked != state:
                # Another thread has begun to check a newer state meanwhile.
                return
            if of_robot is not None:
                self._of_robot = of_robot
            found = (*self._of_robot, *of_joints, *of_config)
            if self._problems.of_model != found or self._problems.shown.value.checking:
                self._problems.set_model(found)

    def run_again(self) -> None:
        """Check the same robot after a file around its model was saved."""
        with self._change.lock:
            self._saves += 1
        self.run()

    def _of_rules(self, robot: Robot, state: _State) -> tuple[Problem, ...]:
        """What the rules find; the files around the model are read once for it."""
        # The import is late so that the first page does not wait for the rules.
        from sambot_viz.checks import check_around, check_robot

        of, saves, found = self._of_files
        if of is not robot or saves != state.saves:
            read: set[Path] = set()
            around = check_around(robot, workspace=self._workspace, read=read)
            found = tuple(around)
            self._of_files = (robot, state.saves, found)
            self.files.set(frozenset(read))
        return (*check_robot(robot, mesh=self._mesh, around=False), *found)

    def _without_published(
        self, problems: list[Problem], robot: Robot, frame: str, file: str | None
    ) -> list[Problem]:
        """Leave out a fixed frame that a node of the package may publish."""
        others = [p for p in problems if p.code != "setup-fixed-frame"]
        if len(others) == len(problems):
            return problems
        # The import is late, as for the rules; and the files are read once.
        from sambot_viz.checks.checked import frame_is_published

        asked = (id(robot), frame, file, self._saves)
        if asked != self._asked[0]:
            published = frame_is_published(robot, frame, file, self._workspace)
            self._asked = (asked, published)
        return others if self._asked[1] else problems

    def _mesh(self, path: Path) -> Mesh | None:
        """A mesh that has been read for the picture; the rules read none themselves.

        Meshes that cannot be drawn are reported by the display that draws them.
        """
        found = self._context.assets.known(Asset("mesh", path))
        return found if isinstance(found, Mesh) else None

    def _state(self) -> _State:
        read_count = self._context.assets.read_count
        return _State(id(self._robot.model), read_count, self._saves)

    def _follow(self) -> None:
        """Check again after a change that may fix, or bring, a problem."""
        if self._checked is not None and self._checked.robot == id(self._robot.model):
            self.run()

    def _of_config(self, robot: Robot) -> list[Problem]:
        from sambot_viz.checks.config_against_robot import check_config

        frame_exists = self._context.fixed_frame in self._context.tree
        return [
            problem
            for problem in check_config(robot, self._document.config)
            if not (frame_exists and problem.code == "setup-fixed-frame")
        ]


def _also(saved: Sequence[Problem], shown: Iterable[Problem]) -> list[Problem]:
    """Return the problems of a save, and the others of the shown version."""
    said = {(problem.code, problem.message) for problem in saved}
    return [*saved, *(p for p in shown if (p.code, p.message) not in said)]
