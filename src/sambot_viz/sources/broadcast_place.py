"""Where a server broadcasts what it shows, as a user writes it and as keys of zenoh."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from sambot_viz.errors import UsageError
from sambot_viz.sources.live.address import Address
from sambot_viz.sources.registry import live_address
from sambot_viz.text import text

_NAME = re.compile(r"[A-Za-z0-9_.-]{1,100}")
_EXAMPLE = "zenoh://HOST:7447/NAME"


@dataclass(frozen=True, slots=True)
class BroadcastPlace:
    """Where something is broadcast.

    Attributes:
        address: of the router, with the name of the broadcast.
    """

    address: Address

    @property
    def label(self) -> str:
        """The place, for people: "lab:7447/arm"."""
        return f"{self.address.label}/{self.address.name}"

    @property
    def frames(self) -> str:
        """The key on which the frames are published."""
        return f"sambot-viz/{self.address.name}/frames"

    @property
    def snapshot(self) -> str:
        """The key that is asked for a snapshot."""
        return f"sambot-viz/{self.address.name}/snapshot"

    @property
    def page(self) -> str:
        """The key that is asked for the address of the origin's page, and its state."""
        return f"sambot-viz/{self.address.name}/page"

    @property
    def origins(self) -> str:
        """The keys of the tokens that say that an origin is there."""
        return self.token("*", "*")

    def token(self, origin: str, version: str) -> str:
        """Return the key of the token of an origin of a version."""
        return f"sambot-viz/{self.address.name}/origin/{origin}/{version}"


def parse_place(uri: str, flag: str) -> BroadcastPlace:
    """Read the place of a broadcast.

    Raises:
        UsageError: it names no router of zenoh, or not what is broadcast there; or the
            package for zenoh is missing.
    """
    scheme, _, rest = uri.partition("://")
    server, _, name = rest.partition("/")
    if scheme.partition("+")[0].lower() != "zenoh" or not _NAME.fullmatch(name):
        raise UsageError(
            f"{flag} {text(uri)}: this is not a router of zenoh and a name of letters, "
            f"digits, '.', '_' and '-'; write {flag} {_EXAMPLE}"
        )
    address = live_address(f"{scheme}://{server}")
    return BroadcastPlace(replace(address, flag=flag, name=name))


EVERY_ORIGIN = "sambot-viz/*/origin/*/*"
"""The keys of the tokens of all origins at a router."""


def name_of(token: str) -> str:
    """Return the name of the broadcast that a token of an origin is of."""
    return token.split("/")[1]


def origin_of(token: str) -> tuple[str, str]:
    """Return who the token of an origin is of, and its version."""
    *_, origin, version = token.split("/")
    return origin, version
