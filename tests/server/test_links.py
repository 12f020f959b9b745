"""The links that are given to viewers, wherever the page was opened."""

from __future__ import annotations

import pytest

from sambot_viz.options import Options
from sambot_viz.server import invitation, listener


def options(**given: object) -> Options:
    return Options(**{"token": None, "presenter": None, **given})  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("given", "opened_at", "link", "only_here"),
    [
        # On this machine only.
        ({}, "http://127.0.0.1:8080/", "http://127.0.0.1:8080/", True),
        # What the browser shows is what works, whatever proxies are between.
        (
            {"token": "secret-word", "base_path": "/robot"},
            "https://lab.example.org/hub/robot/",
            "https://lab.example.org/hub/robot/?token=secret-word",
            False,
        ),
        # Opened beside the server, behind a proxy.
        (
            {
                "allowed_origins": ("https://lab.example.org",),
                "base_path": "/robot",
                "token": "secret-word",
                "presenter": "teach-the-class",
            },
            "http://localhost:8080/robot/",
            "https://lab.example.org/robot/?view=secret-word",
            False,
        ),
        # Opened beside the server, which listens on a network.
        (
            {"host": "192.0.2.7"},
            "http://localhost:8080/",
            "http://192.0.2.7:8080/",
            False,
        ),
    ],
)
def test_viewers_get_an_address_that_works_for_them(
    given: dict[str, object], opened_at: str, link: str, only_here: bool
) -> None:
    made = invitation.invite(options(**given), opened_at)
    assert (made.link, made.only_here) == (link, only_here)
    assert len(set(map(len, made.dark))) == 1 and set("".join(made.dark)) == {"0", "1"}


def test_the_link_of_presenters_is_another_one() -> None:
    given = options(
        allowed_origins=("https://lab.example.org",),
        token="secret-word",
        presenter="teach-the-class",
    )
    assert listener.public_url(given) == "https://lab.example.org/?view=secret-word"
    presenter = listener.public_url(given, presenter=True)
    assert presenter == "https://lab.example.org/?present=teach-the-class"
    assert listener.public_url(options()) is None
