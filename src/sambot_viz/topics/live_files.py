"""The files that a live robot describes itself with, as its source has them."""

from __future__ import annotations

import re
from concurrent.futures import Future, wait
from dataclasses import replace
from pathlib import Path

from sambot_viz import limits
from sambot_viz.errors import Problem, SourceError
from sambot_viz.sources.source import Source

FILES_WITHIN = 60.0
"""All files of a robot are to be there after this time [s]."""
_FILE = re.compile(r"""filename\s*=\s*["'](package://([^"'/]+)/([^"']+))["']""")


def fetch_files(source: Source, text: str, folder: Path) -> tuple[Problem, ...]:
    """Write the files of a description, and report those that the source refuses.

    Args:
        source: gets one request for each file, if it serves files at all.
        text: the description, as XML.
        folder: becomes a folder of packages.
    """
    if "files" not in source.capabilities:
        return ()
    asked: dict[str, tuple[Path, Future[bytes]]] = {}
    later: dict[str, None] = {}
    for uri, package, rest in _FILE.findall(text):
        path = folder / package / rest
        inside = ".." not in Path(rest).parts and package not in (".", "..")
        if not inside or uri in asked:
            continue
        if len(asked) < limits.ASSETS.value:
            asked[uri] = (path, source.fetch_asset(uri))
        else:
            later[uri] = None
    wait([future for _, future in asked.values()], FILES_WITHIN)
    missing: list[Problem] = []
    for uri, (path, future) in asked.items():
        try:
            data = future.result(0)
        except SourceError as error:
            # It says what would allow it; the rest of the robot is shown.
            missing += [replace(p, severity="warning") for p in error.problems]
            continue
        except TimeoutError:
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        manifest = folder / uri.split("/")[2] / "package.xml"
        if not manifest.exists():
            manifest.write_text("<package/>", encoding="utf-8")
    if later:
        size = limits.ASSETS.said(len(asked) + len(later))
        what = f"the description names {size}: {next(iter(later))} and all later ones"
        missing.append(Problem("warning", "mesh-not-served", f"{what} are missing", ""))
    return tuple(missing)
