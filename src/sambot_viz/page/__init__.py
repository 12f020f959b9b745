"""Delivers the scripts and the style sheet that make viser's page look like RViz."""

from __future__ import annotations

import html
from functools import cache
from importlib import resources


@cache
def script() -> str:
    """The text of rviz_look.js."""
    return resources.files(__name__).joinpath("rviz_look.js").read_text("utf-8")


def script_element() -> str:
    """HTML that runs the script once, for viser's public `gui.add_html`.

    A script element inserted as HTML does not run, so the script is the error handler
    of an image whose data is empty; nothing is fetched for it.
    """
    source = html.escape(script(), quote=True)
    return f'<img alt="" src="data:," style="display:none" onerror="{source}">'


def style_element() -> str:
    """HTML that carries the page's style sheet (page/rviz_look.css)."""
    sheet = resources.files(__name__).joinpath("rviz_look.css").read_text("utf-8")
    return f"<style>{sheet}</style>"


def mouse_element(kind: str) -> str:
    """HTML that makes the mouse move the camera as a type of RViz's views does.

    Args:
        kind: the type of the view, such as "Orbit"; one of the program's own names.
    """
    source = resources.files(__name__).joinpath("rviz_mouse.js").read_text("utf-8")
    return (
        f'<i hidden data-sambot-view="{html.escape(kind, quote=True)}"></i>'
        '<img alt="" src="data:," style="display:none" '
        f'onerror="{html.escape(source, quote=True)}">'
    )
