"""Check event handlers and timers of launch files: targets and arguments."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from sambot_viz.checks.around.launch_files.names import bound_names, with_import
from sambot_viz.checks.around.launching.launch_file import LaunchFile
from sambot_viz.checks.around.launching.python_parts import Call, Listing
from sambot_viz.checks.around.place import rewritten, where
from sambot_viz.checks.around.surroundings import Surroundings
from sambot_viz.checks.launch_files import call_name
from sambot_viz.errors import Fix, Problem, nearest

_CODE = "launch-code"
_STOPS = "ros2 launch stops with it"
_REGISTER = "RegisterEventHandler"
_HANDLERS = ("OnExecutionComplete", "OnProcessExit", "OnProcessIO", "OnProcessStart")
_ENDING = frozenset({"create", "spawn_entity.py", "spawner", "spawner.py"})
"""Programs that end by themselves, so that handlers can wait for their end."""
_LISTS = {
    "LaunchDescription": ("initial_entities", 0),
    "GroupAction": ("actions", 0),
    "TimerAction": ("actions", None),
}


def handlers_that_wait(around: Surroundings) -> Iterator[Problem]:
    """Report handlers that wait for an action that nothing starts before."""
    for launch in around.launches:
        handlers = {
            target.id: call
            for call in launch.called(*_HANDLERS)
            if isinstance(target := call.given("target_action"), ast.Name)
        }
        for name, call in handlers.items():
            inside = {id(n) for n in ast.walk(call.node)}
            targets = {id(other.given("target_action")) for other in handlers.values()}
            used = [n for n in ast.walk(launch.tree) if _loads(n, name)]
            started = [n for n in used if id(n) not in targets]
            if isinstance(launch.origin(ast.Name(name)), ast.Call):
                if not any(id(n) not in inside for n in started):
                    yield _waits(launch, name, call, handlers, bool(started))


def _loads(node: ast.AST, name: str) -> bool:
    if not isinstance(node, ast.Name) or node.id != name:
        return False
    return isinstance(node.ctx, ast.Load)


def _waits(
    launch: LaunchFile,
    name: str,
    call: Call,
    handlers: dict[str, Call],
    starts_it: bool,
) -> Problem:
    """Report a handler that waits for its own action, or for one that never starts."""
    target = call.given("target_action") or call.node
    what = "the end of " if call.name == "OnProcessExit" else ""
    cause = f"this handler waits for {what}{name}, which "
    if not starts_it:
        described = next(launch.called("LaunchDescription"), call)
        line = where(described.place, launch.shown)
        cause += "nothing starts: it is not in the LaunchDescription"
        fix = Fix(f"add {name} to that list ({line})")
    else:
        cause += "only this handler starts"
        inside = {n.id for n in ast.walk(call.node) if isinstance(n, ast.Name)}
        free = [n for n in _that_end(launch) if n not in inside and n not in handlers]
        fix = Fix(f"write an action that ends before, or add {name} to the description")
        if len(free) == 1:
            fix = rewritten(target, launch.shown, free[0])
    return Problem.at(
        launch.place(target), "error", _CODE, f"{cause}: it never starts", fix
    )


def _that_end(launch: LaunchFile) -> Iterator[str]:
    """Yield the variables of nodes that end by themselves."""
    for node in ast.walk(launch.tree):
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Call() as value):
                call = next((c for c in launch.called() if c.node is value), None)
                if call and launch.text(call, "executable") in _ENDING:
                    yield name
            case _:
                pass


def texts_for_actions(around: Surroundings) -> Iterator[Problem]:
    """Report a handler with the name of its action in quotation marks."""
    for launch in around.launches:
        bound = bound_names(launch.tree)
        for call in launch.called(*_HANDLERS):
            given = call.given("target_action")
            said = given.value if isinstance(given, ast.Constant) else None
            if given is not None and isinstance(said, str):
                near = said if said in bound else nearest(said, sorted(bound), 0.8)
                yield Problem.at(
                    launch.place(given),
                    "error",
                    _CODE,
                    f"target_action takes an action, not the text '{said}': {_STOPS}",
                    Fix("write the variable of the node")
                    if near is None
                    else rewritten(given, launch.shown, near),
                )


def plain_handlers(around: Surroundings) -> Iterator[Problem]:
    """Report event handlers among actions that no action registers."""
    for launch in around.launches:
        for call in launch.called(*_LISTS):
            value = call.value(*_LISTS[call.name])
            for _, node in value.items if isinstance(value, Listing) else ():
                made = launch.origin(node)
                name = call_name(made.func) if isinstance(made, ast.Call) else ""
                if name in _HANDLERS:
                    right = f"{_REGISTER}({ast.unparse(node)})"
                    hint = f"write {_REGISTER}(…) around it"
                    hint = with_import(hint, _REGISTER, launch)
                    yield Problem.at(
                        launch.place(node),
                        "error",
                        _CODE,
                        f"{name} is an event handler and no action: {_STOPS}",
                        rewritten(node, launch.shown, right, hint),
                    )


def periods(around: Surroundings) -> Iterator[Problem]:
    """Report timers whose period is not a number."""
    for launch in around.launches:
        for call in launch.called("TimerAction", "ROSTimer"):
            given = call.given("period")
            text = given.value if isinstance(given, ast.Constant) else None
            if given is None or not isinstance(text, str):
                continue
            number = text.strip().removesuffix("sec").removesuffix("s").strip()
            try:
                float(text)
            except ValueError:
                known = number.replace(".", "", 1).isdigit()
                yield Problem.at(
                    launch.place(given),
                    "error",
                    _CODE,
                    f"the period '{text}' is not a number of seconds: {_STOPS}",
                    rewritten(given, launch.shown, str(float(number)))
                    if known
                    else "write a number of seconds, such as 5.0",
                )
