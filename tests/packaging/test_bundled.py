"""What comes with the package is found by name."""

from __future__ import annotations

from pathlib import Path

import pytest

from sambot_viz import bundled
from sambot_viz.errors import UsageError


def test_the_default_model_and_config_exist() -> None:
    assert bundled.model_path().name == "sam_bot.urdf.xacro"
    assert bundled.model_path().is_file()
    assert bundled.config_path().name == "urdf_config.rviz"
    assert bundled.config_path().is_file()


def test_models_and_configs_are_listed_without_the_parts_they_include() -> None:
    assert bundled.model_names() == [
        "mbot.urdf.xacro",
        "sam_bot.sdf",
        "sam_bot.urdf.xacro",
        "sam_bot_collision.urdf.xacro",
    ]
    assert bundled.config_names() == ["mbot.rviz", "urdf_config.rviz"]


def test_a_checkout_uses_its_own_folders(repository: Path) -> None:
    if not Path(bundled.__file__).is_relative_to(repository):
        pytest.skip("the package under test is not installed from this checkout")
    assert bundled.assets_folder() == repository / "assets"
    assert bundled.configs_folder() == repository / "rviz"


def test_a_wheel_uses_the_folders_inside_the_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "site-packages" / "sambot_viz"
    (package / "share" / "assets").mkdir(parents=True)
    (tmp_path / "assets").mkdir()
    monkeypatch.setattr(bundled, "__file__", str(package / "bundled.py"))
    assert bundled.assets_folder() == (package / "share" / "assets").resolve()


def test_a_missing_folder_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bundled, "__file__", str(tmp_path / "a" / "b" / "x.py"))
    with pytest.raises(UsageError) as error:
        bundled.configs_folder()
    assert str(error.value) == (
        "this installation has no bundled 'rviz' folder; install sambot-viz again"
    )


def test_an_unknown_name_offers_the_nearest_one() -> None:
    with pytest.raises(UsageError) as error:
        bundled.model_path("sam_bott.urdf.xacro")
    assert str(error.value) == (
        "no bundled model 'sam_bott.urdf.xacro'; did you mean 'sam_bot.urdf.xacro'?"
    )
    with pytest.raises(UsageError, match=r"no bundled config 'mbott\.rviz'"):
        bundled.config_path("mbott.rviz")


def test_a_name_cannot_leave_the_folder() -> None:
    with pytest.raises(UsageError, match="no bundled model"):
        bundled.model_path("../rviz/mbot.rviz")
