"""How a message names the second of two places that contradict each other."""

from __future__ import annotations

from pathlib import PurePath

from sambot_viz.errors import Place


def where(other: Place | None, here: Place | str | None) -> str:
    """Name a place for a sentence, such as "line 12" or "ekf.yaml line 12".

    Args:
        other: the place to name; None names nothing.
        here: where the finding itself is shown; its file is not repeated.
    """
    if other is None:
        return "in the model"
    file = here.file if isinstance(here, Place) else here
    name = "" if other.file == file else f"{PurePath(other.file).name} "
    return f"{name}line {other.line}"
