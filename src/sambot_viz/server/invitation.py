"""The link that is given to viewers, from the page."""

from __future__ import annotations

from urllib.parse import urlsplit

from sambot_viz.options import Options
from sambot_viz.panels.people import Invitation
from sambot_viz.server.listener import public_url, reachable_at, with_secret
from sambot_viz.server.protection.access import only_this_machine


def invite(options: Options, opened_at: str) -> Invitation:
    """Return the link for viewers, also as a QR code.

    Args:
        options: where the server listens, and its secrets.
        opened_at: the address under which a page was opened, as its browser shows it;
            behind a proxy the server may not know it.
    """
    base, here = opened_at, urlsplit(opened_at)
    local = only_this_machine(here.hostname or "")
    public = public_url(options)
    if local and public is not None:
        return _as_code(public, False)
    # Opened beside the server, it has a name that means another machine elsewhere.
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
