"""Link names that contain a blank, which joints write without it."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable


def written_with_blank(
    name: str, links: Iterable[str], named: Container[str]
) -> str | None:
    """Return the link that a joint means by a name without blanks, or None.

    Args:
        name: name in the joint, which is not a link.
        links: names of the links.
        named: names in all joints; a link among them cannot be the answer.
    """
    plain = _plain(name)
    for link in links:
        if " " in link.strip() and link not in named and _plain(link) == plain:
            return None if " " in name else link
    return None


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]+", "", name).lower()
