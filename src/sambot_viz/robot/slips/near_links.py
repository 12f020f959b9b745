"""The link that was meant by a name that no link has."""

from __future__ import annotations

import re
from collections.abc import Iterable

from sambot_viz.edits import write, write_attribute
from sambot_viz.errors import Fix, nearest
from sambot_viz.robot.xml.element import Element

_BESIDE_NAME = re.compile(r"link|frame|[_/\s-]")


def near_link(name: str, possible: Iterable[str]) -> str | None:
    """Return the link that is like a name, or is the same without "link"; or None."""
    links = list(possible)
    bare = [link for link in links if _bare(link) == _bare(name) != ""]
    return bare[0] if len(bare) == 1 else nearest(name, links)


def _bare(name: str) -> str:
    return _BESIDE_NAME.sub("", name.lower())


def one_name(end: Element, name: str, link: Element, more: str = "") -> Fix:
    """Return the fix that gives a link and the end of a joint one name.

    That of the link is the right one; of imu and imu_link, what more elements use.

    Args:
        end: the <parent> or <child>.
        name: the link that it names, which does not exist.
        link: the link that was meant.
        more: the end of the hint.
    """
    near = link.get("name") or ""
    robot = link
    while robot.parent is not None:
        robot = robot.parent
    users = [e for e in robot.iter() if e is not end and e.tag not in ("link", "joint")]
    texts = [t for e in users for t in (e.text.strip(), *e.attributes.values())]
    if _bare(name) == _bare(near) and texts.count(name) > texts.count(near):
        hint = f'write name="{name}" for the link {near} on line {link.place.line}'
        return write_attribute(link.place, "name", near, name, hint=hint + more)
    if end.get("link") is None:
        tag = end.tag
        hint = f"write <{tag}>{near}</{tag}>{more}"
        return write(end.place, name, near, hint=hint)
    hint = f'write link="{near}"{more}'
    return write_attribute(end.place, "link", name, near, hint=hint)
