"""Evaluate calls in a Python launch file that make actions, conditions and texts."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping

from sambot_viz.checks.around.launching.actions import (
    Action,
    ActionGroup,
    Expression,
    ForNodes,
    FromFile,
    Given,
    IncludeFile,
    Joined,
    LaunchArgument,
    Operation,
    RobotText,
    SetArgument,
    ShareFolder,
    StartNode,
    StartProcess,
    UnknownAction,
    WrittenValue,
)
from sambot_viz.checks.around.launching.python_parts import (
    Call,
    Listing,
    PythonValue,
    Table,
    as_text,
)

Made = Callable[[Call], PythonValue]


def _first(*names: str) -> Made:
    """Treat a call as its argument."""

    def make(call: Call) -> PythonValue:
        named = (call.value(name) for name in names)
        found = next((value for value in named if value is not None), None)
        return call.value("", 0) if found is None else found

    return make


def _path(call: Call) -> PythonValue:
    parts = call.value("", 0)
    if isinstance(parts, Listing) and parts.complete:
        return Joined(tuple(as_text(item) for item, _ in parts.items), is_path=True)
    return Joined(call.texts(), is_path=True)


def _folder(call: Call) -> PythonValue:
    path = call.text("", 0, None)
    whole = isinstance(path, Joined) and path.is_path and len(path.parts) > 1
    return Joined(path.parts[:-1], True) if whole and isinstance(path, Joined) else None


def _rewritten(call: Call) -> PythonValue:
    source = call.value("source_file", 0)
    path = source.path if isinstance(source, FromFile) else as_text(source)
    return FromFile(path, call.place, rewritten=True)


def _equals(call: Call) -> PythonValue:
    name = call.text("launch_configuration_name", 0)
    return Operation("equals", (LaunchArgument(name), call.text("expected_value", 1)))


def _differs(call: Call) -> PythonValue:
    return Operation("not", (as_text(_equals(call)),))


def _node(call: Call) -> PythonValue:
    given, known = _parameters(call)
    remappings, all_known = _remappings(call.listing("remappings"))
    arguments = call.listing("arguments")
    return StartNode(
        call.place,
        call.condition,
        call.text("package"),
        call.text("executable", default=call.text("plugin")),
        call.text("name"),
        call.text("namespace"),
        given,
        remappings,
        tuple(as_text(item) for item, _ in arguments.items),
        known and all_known and arguments.complete and call.complete,
        tuple(call.place_of(node) for _, node in arguments.items),
    )


def _parameters(call: Call) -> tuple[tuple[Given, ...], bool]:
    found: list[Given] = []
    listing = call.listing("parameters")
    complete = listing.complete
    for item, node in listing.items:
        if isinstance(item, Table):
            found += _values(call, item, "")
            complete = complete and item.complete
        elif isinstance(item, FromFile):
            found.append(item)
        elif isinstance(item, (Listing, Action, ast.FunctionDef)) or item is None:
            complete = False
        else:
            found.append(FromFile(item, call.place_of(node)))
    return tuple(found), complete


def _values(call: Call, table: Table, above: str) -> list[WrittenValue]:
    found: list[WrittenValue] = []
    for key, value, _, node in table.pairs:
        name, place = Joined((above, key)) if above else key, call.place_of(node)
        if isinstance(value, Table):
            if isinstance(key, str):
                found += _values(call, value, f"{above}{key}.")
            else:
                found.append(WrittenValue(None, None, place))
        elif isinstance(value, Listing) and value.complete:
            texts = tuple(as_text(item) for item, _ in value.items)
            found.append(WrittenValue(name, texts, place))
        else:
            found.append(WrittenValue(name, (as_text(value),), place))
    return found


def _remappings(
    listing: Listing,
) -> tuple[tuple[tuple[Expression, Expression], ...], bool]:
    found: list[tuple[Expression, Expression]] = []
    for item, _ in listing.items:
        if isinstance(item, Listing) and len(item.items) == 2:
            found.append((as_text(item.items[0][0]), as_text(item.items[1][0])))
    return tuple(found), listing.complete and len(found) == len(listing.items)


def _container(call: Call) -> PythonValue:
    node = _node(call)
    parts = call.actions("composable_node_descriptions")
    first = (node,) if isinstance(node, StartNode) and node.executable else ()
    return ActionGroup(call.place, call.condition, (*first, *parts), scoped=False)


def _bridge(call: Call) -> PythonValue:
    config = WrittenValue(
        "config_file", (call.text("config_file", default=None),), call.place
    )
    return StartNode(
        call.place,
        call.condition,
        "ros_gz_bridge",
        "bridge_node",
        call.text("bridge_name"),
        call.text("namespace"),
        (config,),
    )


def _simulator(call: Call) -> PythonValue:
    world = call.text("world_sdf_file", default=None)
    arguments = (world,)
    return StartNode(
        call.place, call.condition, "ros_gz_sim", "gzserver", "", "", (), (), arguments
    )


def _process(call: Call) -> PythonValue:
    words = tuple(as_text(item) for item, _ in call.listing("cmd").items)
    return StartProcess(call.place, call.condition, words)


def _include(call: Call) -> PythonValue:
    given = call.value("launch_arguments")
    pairs: list[tuple[Expression, Expression]] = []
    if isinstance(given, Table):
        pairs += [(pair.key, as_text(pair.value)) for pair in given.pairs]
    elif isinstance(given, Listing):
        pairs += _remappings(given)[0]
    path = call.text("launch_description_source", 0, None)
    return IncludeFile(call.place, call.condition, path, tuple(pairs))


def _declare(call: Call) -> PythonValue:
    default = call.text("default_value", 1, None)
    name = call.text("name", 0)
    return SetArgument(call.place, call.condition, name, default, declares=True)


def _set(call: Call) -> PythonValue:
    name, value = call.text("name", 0), call.text("value", 1)
    return SetArgument(call.place, call.condition, name, value, declares=False)


def _grouped(argument: str, position: int | None, *, scoped: bool = False) -> Made:
    """Treat a call as the actions in one of its arguments."""

    def make(call: Call) -> PythonValue:
        actions = call.actions(argument, position)
        inner = scoped and call.value("scoped") != "False"
        return ActionGroup(call.place, call.condition, actions, inner)

    return make


def _unknown(call: Call) -> PythonValue:
    """Treat the return value of a function as actions that may start."""
    more = UnknownAction(call.place, "true", "OpaqueFunction")
    inner = [a for a in call.actions("function", 0) if not isinstance(a, UnknownAction)]
    return ActionGroup(call.place, None, (*inner, more), scoped=False)


def _description(call: Call) -> PythonValue:
    return call.listing("initial_entities", 0)


def _for_nodes(call: Call) -> PythonValue:
    given: Given = FromFile(call.text("filename", default=None), call.place)
    if call.value("filename") is None:
        value = call.text("value", 1, None)
        given = WrittenValue(call.text("name", 0, None), (value,), call.place)
    return ForNodes(call.place, call.condition, given=(given,))


def _sim_time(call: Call) -> PythonValue:
    given = WrittenValue("use_sim_time", (call.text("value", 0, "True"),), call.place)
    return ForNodes(call.place, call.condition, given=(given,))


def _renamed(call: Call) -> PythonValue:
    pair = (call.text("src", 0, None), call.text("dst", 1, None))
    return ForNodes(call.place, call.condition, remappings=(pair,))


def _namespace(call: Call) -> PythonValue:
    return ForNodes(call.place, call.condition, call.text("namespace", 0, None))


def _nothing(call: Call) -> PythonValue:
    return ActionGroup(call.place, call.condition, (), scoped=False)


def _named(make: Made, names: str) -> dict[str, Made]:
    return dict.fromkeys(names.split(), make)


CALLS: Mapping[str, Made] = {
    "LaunchDescription": _description,
    **_named(_node, "Node LifecycleNode ComposableNode ComposableLifecycleNode"),
    **_named(_container, "ComposableNodeContainer LoadComposableNodes"),
    "RosGzBridge": _bridge,
    "GzServer": _simulator,
    **_named(_process, "ExecuteProcess ExecuteLocal"),
    "IncludeLaunchDescription": _include,
    "DeclareLaunchArgument": _declare,
    "SetLaunchConfiguration": _set,
    "GroupAction": _grouped("actions", 0, scoped=True),
    "TimerAction": _grouped("actions", None),
    "RegisterEventHandler": _grouped("event_handler", 0),
    "OnProcessExit": _grouped("on_exit", None),
    "OnProcessStart": _grouped("on_start", None),
    "OnExecutionComplete": _grouped("on_completion", None),
    "OpaqueFunction": _unknown,
    **_named(_namespace, "PushRosNamespace PushROSNamespace"),
    **_named(_for_nodes, "SetParameter SetParametersFromFile"),
    "SetUseSimTime": _sim_time,
    "SetRemap": _renamed,
    **_named(
        _nothing,
        "AppendEnvironmentVariable EmitEvent LogInfo OnShutdown PopEnvironment "
        "PopLaunchConfigurations PushEnvironment PushLaunchConfigurations ROSTimer "
        "SetEnvironmentVariable SetROSLogDir Shutdown UnsetEnvironmentVariable "
        "UnsetLaunchConfiguration",
    ),
    **_named(
        lambda call: ShareFolder(call.text("package", 0, call.text("package_name"))),
        "FindPackageShare get_package_share_directory get_package_share_path",
    ),
    **_named(_path, "join PathJoinSubstitution"),
    "LaunchConfiguration": lambda call: LaunchArgument(
        call.text("variable_name", 0), call.text("default", 1, None)
    ),
    **_named(lambda call: RobotText(call.text("command", 0, None)), "Command"),
    **_named(lambda call: RobotText(call.text("", 0, None)), "open process_file"),
    "ThisLaunchFileDir": lambda _: ShareFolder(""),
    "dirname": _folder,
    "PythonExpression": lambda call: Operation("eval", (call.text("expression", 0),)),
    "UnlessCondition": lambda call: Operation(
        "not", (call.text("predicate_expression", 0),)
    ),
    "LaunchConfigurationEquals": _equals,
    "LaunchConfigurationNotEquals": _differs,
    "NotSubstitution": lambda call: Operation("not", call.texts()),
    "AndSubstitution": lambda call: Operation("and", call.texts()),
    "OrSubstitution": lambda call: Operation("or", call.texts()),
    "EqualsSubstitution": lambda call: Operation("equals", call.texts()),
    "NotEqualsSubstitution": lambda call: Operation("differs", call.texts()),
    "IfElseSubstitution": lambda call: Operation("if-else", call.texts()),
    **_named(
        _first(
            "predicate_expression",
            "launch_file_path",
            "location",
            "param_file",
            "text",
            "value",
        ),
        "IfCondition TextSubstitution Path str list tuple dict ParameterValue "
        "ParameterFile PythonLaunchDescriptionSource AnyLaunchDescriptionSource "
        "XMLLaunchDescriptionSource YAMLLaunchDescriptionSource "
        "FrontendLaunchDescriptionSource",
    ),
    **_named(_rewritten, "RewrittenYaml ReplaceString"),
}
"""Name of a call → the function that makes its result."""
