"""Find text in a model that stops ``ros2 launch``.

If a launch file passes Command([…]) directly as robot_description, launch reads the
whole text as YAML. xacro keeps comments, so a harmless "TODO: …" is enough to stop it.
The rule reports nothing unless a launch file of the robot does so.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from sambot_viz.checks.launch_files import call_name
from sambot_viz.checks.rule import Subject
from sambot_viz.errors import Place, Problem
from sambot_viz.unsaved import unsaved_text

_DESCRIPTION = "robot_description"
_TRAP = re.compile(r":(?=[ \t\n]|$)|(?<=[ \t\n])#|(?<=\n)\t", re.MULTILINE)
_MODEL_FILE = re.compile(r"[\w.-]+\.(?:urdf|xacro)\b(?!\.)")
_BETWEEN_TAGS = re.compile(r">\s+<")
_SHORTEST_WORDS = 4


def launch_text_as_yaml(subject: Subject) -> Iterator[Problem]:
    """Find the first text that YAML cannot read, where launch reads it as YAML."""
    # xacro writes its own line breaks and indentation between tags.
    model_text = _BETWEEN_TAGS.sub(">\n<", subject.robot.description)
    trap = _TRAP.search(model_text)
    # Search launch files only for a text that could stop one: most models have none.
    if trap is None or not subject.files:
        return
    model = Path(subject.files[0])
    launch = next(_bare_launch_files(subject, model), None)
    if launch is None or _is_text_in_yaml(model_text):
        return
    text = _text_around(model_text, trap.start())
    yield Problem.at(
        _place(subject.files, text) or str(model),
        "warning",
        "launch-text-as-yaml",
        f"the model is fine, but {launch[0]} line {launch[1]} passes its text to "
        'robot_state_publisher as YAML, where a ": ", a " #" or a tab at the start of '
        f"a line is an error: “{text[:60]}”; nothing starts",
        "in the launch file write ParameterValue(Command([…]), value_type=str)",
    )


def _bare_launch_files(subject: Subject, model: Path) -> Iterator[tuple[str, int]]:
    """Yield launch files with a bare Command, by name, and its line.

    Without a package, launch files beside the model and beside its folder count. A
    Command that names other models does not.
    """
    from sambot_viz.checks.around.workspace import Package

    above = model.absolute().parents[:2]
    trusted = subject.robot.file_roots is None
    packages = subject.packages or tuple(
        Package(folder / "launch", "", False, trusted, set()) for folder in above
    )
    for package in packages:
        for launch in package.launches:
            for line in bare_commands(launch.tree, model.name):
                yield launch.path.rpartition("/")[2], line


def bare_commands(tree: ast.Module, model: str) -> list[int]:
    """Return lines with a Command as robot_description, without a ParameterValue.

    Args:
        tree: the launch file.
        model: the name of the model's file; a Command that names others does not count.
    """
    values: dict[str, ast.expr] = {}
    found: list[ast.expr] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            names = (t.id for t in node.targets if isinstance(t, ast.Name))
            values.update(dict.fromkeys(names, node.value))
    for node in ast.walk(tree):
        if not isinstance(node, ast.Dict):
            continue
        for key, value in zip(node.keys, node.values, strict=True):
            if not isinstance(key, ast.Constant) or key.value != _DESCRIPTION:
                continue
            given = values.get(value.id) if isinstance(value, ast.Name) else value
            if given is not None and _is_command(given):
                found.append(given)
    named = [(command, _models_in(command, values)) for command in found]
    return [one.lineno for one, models in named if not models or model in models]


def _models_in(command: ast.expr, values: dict[str, ast.expr]) -> set[str]:
    """Return the names of model files in a Command and in the variables it uses."""
    models: set[str] = set()
    parts = [command]
    for node in ast.walk(command):
        if isinstance(node, ast.Name) and node.id in values:
            parts.append(values[node.id])
    for part in parts:
        for node in ast.walk(part):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                models.update(_MODEL_FILE.findall(node.value))
    return models


def _is_command(node: ast.expr) -> bool:
    return isinstance(node, ast.Call) and call_name(node.func) == "Command"


def _text_around(urdf: str, at: int) -> str:
    """Return the text at an offset, up to the next tags, quotes and line breaks."""
    start = urdf.rfind("\n", 0, at) + 1
    line = urdf[start:].split("\n", 1)[0]
    reached = 0
    for part in re.split(r"<!--|-->|[<>\"]", line):
        reached = line.find(part, reached) + len(part)
        if reached >= at - start:
            return part.strip()
    return line.strip()


def _is_text_in_yaml(text: str) -> bool:
    """Return whether YAML, and so launch, reads it as one plain text."""
    # Import late: few models come this far.
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return isinstance(yaml.load(text, Loader=loader), str)
    except yaml.YAMLError:
        return False


def _place(files: tuple[str, ...], words: str) -> Place | None:
    """Return the place of a text in the files that the user wrote."""
    if len(words) < _SHORTEST_WORDS:
        return None
    for file in files:
        try:
            text = unsaved_text(file)
            text = Path(file).read_text("utf-8", "replace") if text is None else text
        except OSError:
            continue
        at = text.find(words)
        if at >= 0:
            line = text.count("\n", 0, at) + 1
            return Place(file, line, at - text.rfind("\n", 0, at))
    return None
