"""The bundled robots and configs, and which files a user means.

In a checkout the bundled files are the folders ``assets/`` and ``rviz/`` beside
``src/``. A wheel carries both inside the package, in ``sambot_viz/share/`` (see
force-include in pyproject.toml).

Of a package folder the obvious model is taken, and the .rviz file in rviz/, config/ or
launch/.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from sambot_viz.errors import UsageError, did_you_mean
from sambot_viz.files import RECORDING_ENDINGS, is_recording
from sambot_viz.robot.packages.package_model import (
    MODEL_ENDINGS,
    ModelWalk,
    choose_model,
    model_ending,
    models_in,
)

DEFAULT_MODEL = "sam_bot.urdf.xacro"
"""The robot that is shown when no model is given."""

DEFAULT_CONFIG = "urdf_config.rviz"
"""The config that is used when none is given."""

_NAMED = 2
"""Number of recordings named as examples."""
_CONFIG_ENDING = ".rviz"
_CONFIG_FOLDERS = ("rviz", "config", "launch", ".")


def assets_folder() -> Path:
    """Return the folder of the bundled robots.

    Raises:
        UsageError: this installation was made without it.
    """
    return _folder("assets")


def configs_folder() -> Path:
    """Return the folder of the bundled .rviz files.

    Raises:
        UsageError: this installation was made without it.
    """
    return _folder("rviz")


def problems_page() -> Path:
    """Return docs/problems.md, which has a section for each code.

    Raises:
        UsageError: this installation was made without it.
    """
    return _folder("docs") / "problems.md"


def model_path(name: str = DEFAULT_MODEL) -> Path:
    """Return the bundled model file `name`, such as "mbot.urdf.xacro".

    Raises:
        UsageError: there is no such file; the message offers the nearest one.
    """
    return _file(assets_folder(), name, "model")


def config_path(name: str = DEFAULT_CONFIG) -> Path:
    """Return the bundled config file `name`, such as "mbot.rviz".

    Raises:
        UsageError: there is no such file; the message offers the nearest one.
    """
    return _file(configs_folder(), name, "config")


def model_names() -> list[str]:
    """List the bundled models, sorted; files that others include are left out."""
    files = [path.name for path in assets_folder().iterdir()]
    return sorted(name for name in files if name.endswith((".urdf.xacro", ".sdf")))


def config_names() -> list[str]:
    """Return the names of the bundled configs, sorted."""
    return sorted(path.name for path in configs_folder().glob("*.rviz"))


def is_bundled(config: str | None) -> bool:
    """Return whether a config file comes with the program."""
    return config is not None and _is_bundled(Path(config).absolute())


@lru_cache(maxsize=64)
def _is_bundled(path: Path) -> bool:
    # The bundled files never change; this is asked after edits, which ask no disk.
    return path.parent.resolve() == configs_folder() and path.name in config_names()


def _folder(name: str) -> Path:
    package = Path(__file__).resolve().parent
    # The wheel's place comes first: an installed package must not use a folder that
    # happens to be two levels above it.
    places = (package / "share" / name, package.parents[1] / name)
    for place in places:
        if place.is_dir():
            return place
    raise UsageError(
        f"this installation has no bundled '{name}' folder; install sambot-viz again"
    )


def _file(folder: Path, name: str, kind: str) -> Path:
    path = folder / name
    if Path(name).name != name or not path.is_file():
        names = model_names() if kind == "model" else config_names()
        raise UsageError(f"no bundled {kind} '{name}'; {did_you_mean(name, names)}")
    return path


class Found(NamedTuple):
    """The files to show.

    Attributes:
        model: the model file.
        config: the .rviz file, or None when none was given and none belongs to the
            model; the bundled one is then used, with a fixed frame of the robot.
    """

    model: Path
    config: Path | None


def find(model: Path | None, config: Path | None = None) -> Found:
    """Return the model and config files to show.

    Args:
        model: a file, a package folder, or None for the bundled robot.
        config: a .rviz file, or None for the one that belongs to the model.

    Raises:
        UsageError: there is none, or there are several models and no obvious one.
    """
    # os.path answers for names that no file system takes; Path raises OSError.
    if config is not None and not os.path.isfile(config):
        raise UsageError(missing("config", config))
    if model is None:
        return Found(model_path(), config)
    if not os.path.exists(model):
        raise UsageError(missing("model", model))
    if not model.is_dir():
        return Found(model, config)
    found = _model_in(model)
    return Found(found, config or config_in(model))


def _model_in(folder: Path) -> Path:
    walk = ModelWalk()
    models = models_in(folder, walk)
    chosen = choose_model(folder, models)
    if chosen is not None:
        return chosen
    raise UsageError(no_model_chosen(folder, models, walk))


def no_model_chosen(folder: Path, models: Sequence[Path], walk: ModelWalk) -> str:
    """Return why no model of a folder is chosen.

    Args:
        folder: the folder.
        models: the models in it.
        walk: the search that found them.
    """
    if not models:
        endings = ", ".join(f"*{ending}" for ending in MODEL_ENDINGS)
        meant = _recordings_below(folder) or "give the model file itself"
        found = f"no {endings} in it has a link"
        if walk.left_out:
            found = f"no {endings} that was found has a link, and {walk.left_out}"
        return f"no model in the folder '{folder}': {found}; {meant}"
    names = ", ".join(str(path.relative_to(folder)) for path in models[:8])
    more = f" and {len(models) - 8} more" if len(models) > 8 else ""
    return (
        f"several models in the folder '{folder}' ({names}{more}); give the one to show"
    )


def _recordings_below(folder: Path) -> str:
    """Name subfolders that are recordings; empty when there are none."""
    found = sorted(p.name for p in folder.iterdir() if p.is_dir() and is_recording(p))
    if not found:
        return ""
    names = " and ".join(f"'{name}'" for name in found[:_NAMED])
    more = f", and {len(found) - _NAMED} more" if len(found) > _NAMED else ""
    return f"there are recordings in its folders {names}{more}; give one of them"


def config_in(folder: Path) -> Path | None:
    """Return the .rviz file that belongs to the model of a package, or None."""
    for name in _CONFIG_FOLDERS:
        files = _files(folder / name, (_CONFIG_ENDING,))
        for path in files:
            if path.name == DEFAULT_CONFIG:
                return path
        if files:
            return files[0]
    return None


def _files(folder: Path, endings: Iterable[str]) -> list[Path]:
    if not folder.is_dir():
        return []
    ends = tuple(endings)
    return sorted(p for p in folder.iterdir() if p.name.endswith(ends) and p.is_file())


def missing(what: str, path: Path) -> str:
    """Say that a model or a config does not exist, and which file may be meant."""
    endings = MODEL_ENDINGS
    if what == "config" or path.suffix == _CONFIG_ENDING:
        what, endings = "config", (_CONFIG_ENDING,)
    elif path.suffix in RECORDING_ENDINGS:
        what, endings = "recording", RECORDING_ENDINGS
    folder = path.parent
    if not folder.is_dir():
        return f"no {what} '{path}': the folder '{folder}' does not exist"
    return f"no {what} '{path}': there is no such file; {_near(path, endings)}"


def _near(path: Path, endings: Sequence[str]) -> str:
    """Name the files of a kind that are where a missing one was looked for."""
    folder = path.parent
    if names := [p.name for p in _files(folder, endings)]:
        return did_you_mean(path.name, names, _before_ending)
    inner = [str(p) for f in _inner_folders(folder) for p in _files(f, endings)]
    if inner:
        return did_you_mean(str(path), inner)
    kinds = " or ".join(f"*{ending}" for ending in endings)
    where = "this folder" if folder == Path() else f"the folder '{folder}'"
    return f"{where} has no {kinds}"


def _inner_folders(folder: Path) -> list[Path]:
    with suppress(OSError):
        return sorted(p for p in folder.iterdir() if p.is_dir() and p.name[0] != ".")
    return []


def _before_ending(name: str) -> str:
    """Return a name without its ending, which all files of a kind share."""
    return name.removesuffix(model_ending(name) or Path(name).suffix)


def poses_beside(model: Path) -> Path:
    """Return the poses file of a model: robot.urdf.xacro has robot.poses.yaml.

    Those of the bundled robot are kept in the working folder: its own one belongs to
    the package.
    """
    stem = model.name
    for ending in (".xacro", ".urdf", ".sdf"):
        stem = stem.removesuffix(ending)
    own = model.resolve() != model_path().resolve()
    return (model.parent if own else Path.cwd()) / f"{stem}.poses.yaml"
