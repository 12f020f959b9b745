"""Rules of ROS that give topics other names: ``FROM:=TO``."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from sambot_viz.errors import UsageError
from sambot_viz.text import text

NODES = ("rviz", "rviz2")
"""Whose rules are taken: a rule may be meant for one node of several."""
_NAMESPACE, _NODE = "__ns", ("__node", "__name")
_RULE = re.compile(r"(?:(?P<node>\w+):)?(?P<name>[\w/~]+):=(?P<other>[\w/~]+)")


def remaps_of(rules: Iterable[str]) -> Mapping[str, str]:
    """Return the topics that have other names at the robot: name here → name there.

    Relative names are in the namespace of a rule ``__ns:=/robot1``; rules for other
    nodes, and for the name of the node, are ignored.

    Raises:
        UsageError: a word is not a rule.
    """
    found: dict[str, str] = {}
    namespace = ""
    for rule in rules:
        match = _RULE.fullmatch(rule.strip())
        if match is None:
            raise UsageError(
                f"'{text(rule, 120)}' is no rule: write FROM:=TO, as in "
                "/scan:=/robot1/scan"
            )
        name, other = match["name"], match["other"]
        if (match["node"] or NODES[0]) not in NODES or name in _NODE:
            continue
        if name == _NAMESPACE:
            namespace = other
        else:
            found[name] = other
    # The namespace applies to all rules, also to earlier ones.
    return {
        _absolute(name, namespace): _absolute(other, namespace)
        for name, other in found.items()
    }


def _absolute(name: str, namespace: str) -> str:
    if name.startswith("/"):
        return name
    inner = name.removeprefix("~/")
    space = f"{namespace}/{NODES[0]}" if inner != name else namespace
    return f"/{space}/{inner}".replace("//", "/").replace("//", "/")
