"""Follow the actions of launch files, with arguments, groups and includes."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Mapping
from contextlib import contextmanager

from sambot_viz import limits
from sambot_viz.checks.around.files.gazebo import Fact
from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.launching.actions import (
    Action,
    ActionGroup,
    Expression,
    ForNodes,
    Given,
    IncludeFile,
    SetArgument,
    StartNode,
    StartProcess,
    UnknownAction,
)
from sambot_viz.checks.around.launching.texts import LaunchTexts
from sambot_viz.checks.around.running.given import NodeParameters, given_to
from sambot_viz.checks.around.running.includes import actions_of_known, installed_as
from sambot_viz.checks.around.running.known import known_nodes
from sambot_viz.checks.around.running.parameter_files import options_in
from sambot_viz.checks.around.running.paths import paths_of
from sambot_viz.checks.around.running.simulated import simulator_of
from sambot_viz.checks.around.running.system import (
    GivenFile,
    GivenParameter,
    RunningNode,
    Starts,
    UnknownStart,
)
from sambot_viz.checks.around.workspace import Package
from sambot_viz.errors import Place

_NAMES = ("__node", "__name")

Pairs = tuple[tuple[str, str], ...]


class LaunchEvaluation:
    """Collects what launch files start.

    Args:
        find: returns a package that is here by its name.
        arguments: of the command line, as `ros2 launch` takes them.

    Attributes:
        nodes: the nodes.
        unknown: actions that may start more.
        included: the launch files that others include.
        declared: names of launch arguments.
        paths, unclear: as `RunningSystem` has them.
    """

    def __init__(
        self,
        find: Callable[[str], Package | None],
        arguments: Mapping[str, str] | None = None,
    ) -> None:
        self._find = find
        self.nodes: list[RunningNode] = []
        self.unknown: list[UnknownStart] = []
        self.included: set[tuple[Package, str]] = set()
        self.declared: set[str] = set()
        self.paths: dict[Fact, None] = {}
        self.unclear: dict[tuple[str, str, Place], Place] = {}
        self._set_at: dict[str, Place] = {}
        self._texts = LaunchTexts()
        self._texts.arguments.update(arguments or {})
        self._starts: Starts = "yes"
        self._namespace: str | None = "/"
        self._given: tuple[GivenParameter, ...] = ()
        self._remappings: Pairs = ()
        self._chain: tuple[Place, ...] = ()
        self._files: tuple[tuple[Package, str], ...] = ()
        self._left = limits.LAUNCH_STEPS.value

    def run(self, package: Package, path: str) -> None:
        """Follow a launch file."""
        actions = package.actions(path)
        if actions is None:
            place = Place(package.shown(path), 1)
            what = "a launch file that cannot be read"
            self.unknown.append(UnknownStart(what, place))
            return
        below = path.rpartition("/")[0]
        folder, files = self._texts.folder, self._files
        self._texts.folder = f"{SHARE}{package.name}/{below}".rstrip("/")
        self._files = (*files, (package, path))
        self._all(actions)
        self._texts.folder, self._files = folder, files

    def _all(self, actions: Iterable[Action]) -> None:
        for action in actions:
            self._left -= 1
            if self._left < 0:
                return
            before = self._starts
            truth = self._texts.truth(action.condition)
            doubt = self._texts.no_truth(action.condition) if truth is None else None
            if doubt is not None and before != "no":
                set_at = self._set_at.get(doubt[0], action.place)
                self.unclear.setdefault((*doubt, set_at), action.place)
            self._starts = _both(before, truth)
            if self._starts != "no":
                self.paths |= dict.fromkeys(paths_of(action, self._texts))
            self._one(action)
            self._starts = before

    def _one(self, action: Action) -> None:
        match action:
            case SetArgument():
                self._set(action)
            case StartNode():
                self._node(action)
            case StartProcess():
                self._process(action)
            case IncludeFile() if self._starts != "no":
                self._include(action)
            case ActionGroup(actions=actions, scoped=True):
                with self._scope():
                    self._all(actions)
            case ActionGroup(actions=actions):
                self._all(actions)
            case ForNodes() if self._starts != "no":
                self._for_nodes(action)
            case UnknownAction(what=what) if self._starts != "no":
                self.unknown.append(UnknownStart(what, action.place))
            case _:
                pass

    @contextmanager
    def _scope(self) -> Generator[None, None, None]:
        """Restore all settings at the end."""
        arguments = dict(self._texts.arguments)
        before = self._namespace, self._given, self._remappings
        yield
        self._texts.arguments = arguments
        self._namespace, self._given, self._remappings = before

    def _set(self, action: SetArgument) -> None:
        name = self._texts.text(action.name)
        known = self._texts.arguments
        if name is not None and action.declares:
            self.declared.add(name)
        if name is None or self._starts == "no" or (action.declares and name in known):
            return
        certain = self._starts == "yes"
        known[name] = self._texts.settled(action.value) if certain else None
        self._set_at[name] = action.place

    def _for_nodes(self, action: ForNodes) -> None:
        certain = self._starts == "yes"
        if action.namespace != "":
            below = self._below(action.namespace)
            self._namespace = below if certain else None
        given = self._parameters(action.given, "", None)
        self._given = (*self._given, *given.values)
        self._remappings = (*self._pairs(action.remappings), *self._remappings)

    def _below(self, name: Expression) -> str | None:
        """Return a namespace below the surrounding one."""
        text = self._texts.text(name)
        if text is None or (self._namespace is None and not text.startswith("/")):
            return None
        above = "" if text.startswith("/") else self._namespace or ""
        return (
            f"/{above.strip('/')}/{text.strip('/')}".replace("//", "/").rstrip("/")
            or "/"
        )

    def _include(self, action: IncludeFile) -> None:
        text = self._texts.text
        path = text(action.path)
        given = {
            name: self._texts.settled(value)
            for name, value in ((text(n), v) for n, v in action.arguments)
            if name is not None
        }
        name, _, below = (path or "").removeprefix(SHARE).partition("/")
        if path is None or not path.startswith(SHARE):
            self.unknown.append(UnknownStart("a launch file", action.place))
            return
        package = self._find(name)
        file = None if package is None else installed_as(package, below)
        known = known_nodes().launches.get((name, below.rpartition("/")[2]))
        self._texts.arguments |= given
        self._set_at |= dict.fromkeys(given, action.place)
        chain = self._chain
        self._chain = (*chain, action.place)
        if package is not None and file is not None:
            self.included.add((package, file))
            if (package, file) not in self._files:
                self.run(package, file)
        elif known is not None:
            self._all(actions_of_known(known, action.place))
        elif package is not None or name not in known_nodes().packages:
            what = f"{below.rpartition('/')[2]} of {name}"
            self.unknown.append(UnknownStart(what, action.place))
        self._chain = chain

    def _process(self, action: StartProcess) -> None:
        words = " ".join(self._texts.text(word) or "" for word in action.words).split()
        found = simulator_of(words)
        if found is not None:
            package, given = found
            self._add(package, "gzserver", "gazebo", action.place, arguments=given)

    def _node(self, action: StartNode) -> None:
        text = self._texts.text
        package, program = text(action.package) or "", text(action.executable) or ""
        words = tuple(text(word) for word in action.arguments)
        options = options_in(words)
        named = [new for old, new in options["remap"] if old in _NAMES]
        name = named[-1] if named else text(action.name)
        known = known_nodes().nodes.get((package, program))
        if name == "":
            name = known.name if known is not None else program
        namespace = self._below(action.namespace)
        moved = [new for old, new in options["remap"] if old == "__ns"]
        namespace = moved[-1] if moved else namespace
        given = self._parameters(action.given, name or "", namespace)
        in_words = (
            GivenParameter(old, (new,), action.place) for old, new in options["value"]
        )
        remappings = (
            *(pair for pair in options["remap"] if not pair[0].startswith("__")),
            *self._pairs(action.remappings),
            *self._remappings,
        )
        self._add(
            package,
            program,
            name or "",
            action.place,
            namespace=namespace or "",
            parameters=(*self._given, *given.values, *in_words),
            files=given.files,
            known=given.complete and action.complete and not options["file"],
            remappings=remappings,
            arguments=words,
            argument_places=action.argument_places,
        )

    def _add(
        self,
        package: str,
        program: str,
        name: str,
        place: Place,
        *,
        namespace: str = "/",
        parameters: tuple[GivenParameter, ...] = (),
        known: bool = True,
        remappings: Pairs = (),
        arguments: tuple[str | None, ...] = (),
        argument_places: tuple[Place, ...] = (),
        files: tuple[GivenFile, ...] = (),
    ) -> None:
        self.nodes.append(
            RunningNode(
                package,
                program,
                name,
                namespace,
                self._starts,
                parameters,
                known,
                remappings,
                arguments,
                place,
                self._chain,
                argument_places=argument_places,
                files=files,
            )
        )

    def _pairs(
        self, written: Iterable[tuple[Expression, Expression]]
    ) -> tuple[tuple[str, str], ...]:
        text = self._texts.text
        both = ((text(old), text(new)) for old, new in written)
        return tuple((old, new) for old, new in both if old is not None and new)

    def _parameters(
        self, given: Iterable[Given], name: str, namespace: str | None
    ) -> NodeParameters:
        package = self._files[-1][0]
        return given_to(given, self._texts, package, self._find, name, namespace)


def _both(around: Starts, truth: bool | None) -> Starts:
    """Return whether an action below a condition starts."""
    if around == "no" or truth is False:
        return "no"
    return "unknown" if around == "unknown" or truth is None else "yes"
