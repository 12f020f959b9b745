"""The robots and .rviz configs that come with the package.

In a checkout they are the folders ``assets/`` and ``rviz/`` beside ``src/``. A wheel
carries both inside the package, in ``sambot_viz/share/`` (see force-include in
pyproject.toml).
"""

from __future__ import annotations

from pathlib import Path

from sambot_viz.errors import UsageError, did_you_mean

DEFAULT_MODEL = "sam_bot.urdf.xacro"
"""The robot that is shown when no model is given."""

DEFAULT_CONFIG = "urdf_config.rviz"
"""The config that is used when none is given."""


def assets_folder() -> Path:
    """The folder of the bundled robots.

    Raises:
        UsageError: this installation was made without it.
    """
    return _folder("assets")


def configs_folder() -> Path:
    """The folder of the bundled .rviz files.

    Raises:
        UsageError: this installation was made without it.
    """
    return _folder("rviz")


def model_path(name: str = DEFAULT_MODEL) -> Path:
    """The bundled model file `name`, such as "mbot.urdf.xacro".

    Raises:
        UsageError: there is no such file; the message offers the nearest one.
    """
    return _file(assets_folder(), name, "model")


def config_path(name: str = DEFAULT_CONFIG) -> Path:
    """The bundled config file `name`, such as "mbot.rviz".

    Raises:
        UsageError: there is no such file; the message offers the nearest one.
    """
    return _file(configs_folder(), name, "config")


def model_names() -> list[str]:
    """The names of the bundled models, sorted; files that others include left out."""
    return sorted(path.name for path in assets_folder().glob("*.urdf.xacro"))


def config_names() -> list[str]:
    """The names of the bundled configs, sorted."""
    return sorted(path.name for path in configs_folder().glob("*.rviz"))


def _folder(name: str) -> Path:
    package = Path(__file__).resolve().parent
    # The wheel's place comes first: an installed package must not pick up a folder
    # that happens to stand two levels above it.
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
