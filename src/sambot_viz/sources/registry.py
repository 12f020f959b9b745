"""The kinds of live sources, by what their addresses begin with."""

from __future__ import annotations

from sambot_viz.errors import UsageError
from sambot_viz.extras import require
from sambot_viz.files import LIVE_SOURCES, is_web_folder
from sambot_viz.sources.live.address import Address, parse_address
from sambot_viz.sources.source import Source
from sambot_viz.text import text

KNOWN = f"FILE or folder of a recording, {LIVE_SOURCES}"
"""What `--source` takes, for help and messages."""
_LATER = ("rclpy",)
_LIVE = ("foxglove", "rosbridge", "ws", "wss", "zenoh", "dds")
_EXTRAS = {"zenoh": "zenoh", "dds": "cyclonedds"}
"""Kinds that need a package → its module; the extra is called like the kind."""


def is_live(uri: str) -> bool:
    """Return whether an address is of a live source, for `open_source`."""
    return _scheme(uri) in _LIVE or is_web_folder(uri)


def live_address(uri: str) -> Address:
    """Parse the address of a live source.

    Args:
        uri: such as foxglove://robot:8765/path, foxglove+wss://lab or
            rosbridge://robot:9090; or the folder of a recording that is still made,
            http://lab/runs/monday/.

    Raises:
        UsageError: there is no such kind of source, the address is invalid, or a
            package is missing.
    """
    if is_web_folder(uri):
        return parse_address(uri)
    scheme = _scheme(uri)
    if scheme in _LATER:
        raise UsageError(f"{text(uri)}: {scheme} comes later; known: {KNOWN}")
    if scheme not in _LIVE:
        raise UsageError(f"{text(uri)}: unknown kind of source; known: {KNOWN}")
    if scheme in _EXTRAS:
        needs = f"{text(uri)}: needs {_EXTRAS[scheme]}"
        require(scheme, _EXTRAS[scheme], needs)
    return parse_address(uri)


def open_source(uri: str) -> Source:
    """Return the source at an address; it connects when it is opened.

    Raises:
        UsageError: as `live_address`.
    """
    address = live_address(uri)
    if address.protocol == "zenoh":
        from sambot_viz.sources.zenoh.zenoh_source import ZenohSource

        return ZenohSource(uri, address)
    if address.protocol == "dds":
        from sambot_viz.sources.dds.dds_source import DdsSource

        return DdsSource(uri, address)
    if address.protocol == "http":
        from sambot_viz.sources.follow.followed_recording import FollowedRecording

        return FollowedRecording(uri, address)
    # websockets takes 0.1 s to import, and most commands need none.
    from sambot_viz.sources.foxglove import FoxgloveConversation
    from sambot_viz.sources.foxglove_wire import SUBPROTOCOLS
    from sambot_viz.sources.rosbridge import RosbridgeConversation
    from sambot_viz.sources.websocket.websocket_source import WebsocketSource

    if address.protocol == "rosbridge":
        return WebsocketSource(uri, address, RosbridgeConversation)
    return WebsocketSource(uri, address, FoxgloveConversation, SUBPROTOCOLS)


def _scheme(uri: str) -> str:
    scheme, colon, _ = uri.partition(":")
    return scheme.lower().partition("+")[0] if colon else ""
