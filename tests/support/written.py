"""Writes what the server asks the editor of a page to write."""

from __future__ import annotations

from typing import Any

from protocol_client import ProtocolClient


def write_wanted(client: ProtocolClient, command: str, *values: object) -> None:
    """Send a command, and each change that it asks for, as the page does.

    Args:
        client: a page whose panel Model is open.
        command: such as "model/revert".
        values: of the command.
    """

    def wanted() -> dict[str, Any]:
        return client.rows.get("model/wanted", {}).get("value") or {"number": 0}

    before = wanted()["number"]
    client.act(command, *values)
    client.wait_until(lambda: wanted()["number"] > before)
    shift = 0
    for number, change in enumerate(wanted()["changes"]):
        start, end, new = change["from"], change["to"], change["insert"]
        version = wanted()["version"] + number
        place = start + shift, end + shift
        client.act("model/type", wanted()["file"], version, *place, new, False)
        shift += len(new.encode("utf-16-le")) // 2 - end + start
