from __future__ import annotations

from collections.abc import Callable

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.rviz import RvizConfig

Parse = Callable[[str], RvizConfig]

VIEWS = """\
Visualization Manager:
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 3  # close
      Name: Current View
      Near Clip Distance: 0.5
      Value: Orbit (rviz)
    Saved:
      - Class: rviz_default_plugins/TopDownOrtho
        Name: from above
        Scale: 50
      - Class: my_plugins/Film
        Name: film
        Speed: 2
"""


def test_the_current_and_the_saved_views_are_read(parse: Parse):
    config = parse(VIEWS)
    assert config.view.name == "Current View"
    assert config.view.get("Distance") == 3.0
    assert config.view.get("Target Frame") == "<Fixed Frame>"
    assert [(v.name, v.supported) for v in config.saved_views] == [
        ("from above", True),
        ("film", False),
    ]
    assert config.saved_views[0].get("Scale") == 50.0


def test_without_a_view_there_is_rviz_s_orbit_view(parse: Parse):
    config = parse("Panels: []\n")
    assert config.view.kind == "rviz_default_plugins/Orbit"
    assert not config.modified
    config.view.set("Distance", 2)
    assert config.to_yaml() == (
        "Panels: []\n"
        "Visualization Manager:\n"
        "  Views:\n"
        "    Current:\n"
        "      Class: rviz_default_plugins/Orbit\n"
        "      Distance: 2\n"
        "      Name: Current View\n"
        "      Value: Orbit (rviz_default_plugins)\n"
    )


def test_a_view_without_a_class_is_rviz_s_orbit_view(parse: Parse):
    config = parse("Visualization Manager:\n  Views:\n    Current:\n      Yaw: 1\n")
    assert config.view.kind == "rviz_default_plugins/Orbit"
    assert config.view.get("Yaw") == 0.785398


def test_a_moved_camera_changes_its_lines_only(parse: Parse):
    config = parse(VIEWS)
    config.view.set("Distance", 4.5)
    assert config.to_yaml() == VIEWS.replace("Distance: 3", "Distance: 4.5")


def test_the_current_view_is_saved_under_its_class_s_name(parse: Parse):
    config = parse(VIEWS)
    saved = config.save_view()
    assert saved.name == "Orbit"
    assert config.save_view(name="mine").name == "mine"
    assert [v.name for v in config.saved_views] == [
        "from above",
        "film",
        "Orbit",
        "mine",
    ]
    config.view.set("Distance", 9)
    assert saved.get("Distance") == 3.0
    assert config.to_yaml().endswith(
        "      - Class: rviz_default_plugins/Orbit\n"
        "        Distance: 3\n"
        "        Name: mine\n"
        "        Near Clip Distance: 0.5\n"
        "        Value: Orbit (rviz)\n"
    )


def test_the_first_saved_view_replaces_the_tilde(parse: Parse):
    config = parse("Visualization Manager:\n  Views:\n    Saved: ~\n")
    config.save_view(name="first")
    assert [v.name for v in parse(config.to_yaml()).saved_views] == ["first"]
    config.remove_view(config.saved_views[0])
    assert config.saved_views == ()
    assert "    Saved: ~\n" in config.to_yaml()


def test_a_saved_view_is_renamed_and_removed(parse: Parse):
    config = parse(VIEWS)
    above, film = config.saved_views
    above.rename("top")
    config.remove_view(film)
    assert [v.name for v in parse(config.to_yaml()).saved_views] == ["top"]
    with pytest.raises(UsageError, match=r"'film' .* is not one of the saved views"):
        config.remove_view(film)


def test_a_saved_view_that_was_removed_is_put_back_where_it_was(parse: Parse):
    config = parse(VIEWS)
    above, film = config.saved_views
    for view in (above, film):
        config.put_back_view(config.remove_view(view))
        assert config.saved_views == (above, film)
        assert config.to_yaml() == VIEWS
    of_above = config.remove_view(above)
    config.remove_view(film)
    config.put_back_view(of_above)
    assert config.saved_views == (above,)


def test_a_detached_view_changes_nothing_before_it_is_stored(parse: Parse):
    config = parse(VIEWS)
    view = config.detached_view(config.saved_views[0])
    assert (view.kind, view.name) == (
        "rviz_default_plugins/TopDownOrtho",
        "Current View",
    )
    view.set("Scale", 7)
    assert config.to_yaml() == VIEWS
    config.store_view(view)
    assert config.saved_views[0].get("Scale") == 50.0
    again = parse(config.to_yaml()).view
    assert (again.name, again.get("Scale")) == ("Current View", 7.0)
    view.set("Scale", 8)
    assert config.view.get("Scale") == 7.0


def test_a_stored_view_changes_the_lines_that_differ(parse: Parse):
    config = parse(VIEWS)
    view = config.detached_view()
    config.store_view(view)
    assert config.to_yaml() == VIEWS
    view.set("Distance", 4.5)
    config.store_view(view)
    assert config.to_yaml() == VIEWS.replace("Distance: 3", "Distance: 4.5")


def test_a_view_of_an_unknown_class_is_stored_as_it_is(parse: Parse):
    config = parse(VIEWS)
    config.store_view(config.detached_view(config.saved_views[1]))
    assert config.view.raw == {
        "Class": "my_plugins/Film",
        "Name": "Current View",
        "Speed": "2",
    }
    before = config.to_yaml()
    config.store_view(config.detached_view())
    assert config.to_yaml() == before


def test_another_class_of_view_keeps_what_both_have(parse: Parse):
    config = parse(VIEWS)
    view = config.new_view("rviz_default_plugins/TopDownOrtho", config.view)
    assert view.get("Near Clip Distance") == 0.5
    assert view.get("Scale") == 10.0
    config.store_view(view)
    again = parse(config.to_yaml()).view
    assert again.kind == "rviz_default_plugins/TopDownOrtho"
    assert again.raw["Value"] == "TopDownOrtho (rviz_default_plugins)"
    assert "Distance" not in again.raw


def test_the_views_of_a_ros_1_file_keep_its_names(parse: Parse):
    config = parse(VIEWS.replace("rviz_default_plugins/", "rviz/"))
    assert config.view.class_id == "rviz/Orbit"
    view = config.new_view("rviz_default_plugins/TopDownOrtho", config.view)
    assert view.class_id == "rviz/TopDownOrtho"
    assert view.kind == "rviz_default_plugins/TopDownOrtho"
