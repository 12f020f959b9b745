"""The link for viewers that the page shows."""

from __future__ import annotations

from urllib.parse import urlsplit

from sambot_viz.options import Options
from sambot_viz.panels.people import Invitation
from sambot_viz.server.listener import public_url, reachable_at, with_secret
from sambot_viz.server.protection.access import only_this_machine


def invite(options: Options, opened_at: str) -> Invitation:
    """Return the link for viewers, also as a QR code.

    Args:
        options: address to listen on, and the secrets.
        opened_at: address at which the user has opened the page; only the browser
            knows it when a proxy is in between.
    """
    base, here = opened_at, urlsplit(opened_at)
    local = only_this_machine(here.hostname or "")
    public = public_url(options)
    if local and public is not None:
        return _as_code(public, False)
    # A name that is local to this machine would lead viewers to their own.
    if local and not only_this_machine(options.host):
        host = reachable_at(options.host)
        name = f"[{host}]" if ":" in host else host
        port = "" if here.port is None else f":{here.port}"
        base, local = here._replace(netloc=f"{name}{port}").geturl(), False
    return _as_code(with_secret(base, options), local)


def _as_code(link: str, only_here: bool) -> Invitation:
    import segno

    rows = segno.make(link, error="m", micro=False).matrix
    dark = ["".join("1" if module else "0" for module in row) for row in rows]
    return Invitation(link, dark, only_here)
