"""Read the parameters that a node gets from files and arguments."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import pairwise

from sambot_viz.checks.around.files.launch_values import SHARE
from sambot_viz.checks.around.files.parameters import YamlFile
from sambot_viz.checks.around.running.system import GivenParameter
from sambot_viz.checks.around.workspace import Package

_OPTIONS = {"-r": "remap", "--remap": "remap", "-p": "value", "--params-file": "file"}


def parameters_for(
    file: YamlFile, name: str, namespace: str | None
) -> Iterator[GivenParameter]:
    """Yield the parameters of a file that a node reads.

    Args:
        file: the file.
        name: of the node.
        namespace: None for an unknown one, which matches any in the file.
    """
    path = None if namespace is None else f"{namespace.rstrip('/')}/{name}"
    for key in file.nodes:
        if _fits(key, name, path):
            for parameter in file.of(key).values():
                yield GivenParameter(
                    parameter.name, parameter.values, parameter.value_place
                )


def located(package: Package, path: str) -> str:
    """Return the path in a package that the relative path of a YAML file means.

    It is relative to the working folder, so exactly one file must match.
    """
    if path.startswith("/") or not path.endswith((".yaml", ".yml")):
        return path
    ending = f"/{path.removeprefix('./')}"
    fit = [f.path for f in package.yaml_files if f"/{f.path}".endswith(ending)]
    return f"{SHARE}{package.name}/{fit[0]}" if len(fit) == 1 else path


def _fits(key: str, name: str, path: str | None) -> bool:
    whole = "/" + key.strip("/")
    if path is None:
        return whole.rpartition("/")[2] in (name, "*", "**")
    pattern = re.escape(whole).replace(r"/\*\*", "(/[^/]+)*").replace(r"\*", "[^/]+")
    return re.fullmatch(pattern, path) is not None


def options_in(words: Iterable[str | None]) -> dict[str, list[tuple[str, str]]]:
    """Read the options after --ros-args: remappings, parameters and their files."""
    found: dict[str, list[tuple[str, str]]] = {"remap": [], "value": [], "file": []}
    for option, word in pairwise(words):
        kind = _OPTIONS.get(option or "")
        if kind is not None and word is not None:
            old, _, new = word.partition(":=")
            found[kind].append((old, new))
    return found
