from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from sambot_viz.inputs import declarations as load_declarations
from sambot_viz.rviz import Declarations, RvizConfig
from sambot_viz.rviz.support_report import config_report

TEXT = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
Visualization Manager:
  Displays:
    - Class: rviz_common/Group
      Name: robots
      Enabled: true
      Displays:
        - Class: rviz_default_plugins/RobotModel
          Name: R
          Enabled: true
          Alpha: 0.30000001192092896
          Update Interval: 0
          Mass Properties:
            Inertia: true
          Glow: 1
    - Class: my_plugins/Radar
      Name: radar
      Range: 9
  Global Options:
    Fixed Frame: map
  Tools:
    - Class: rviz_default_plugins/Measure
    - Class: rviz_default_plugins/Select
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Name: Current View
      Distance: 3
    Saved:
      - Class: my_plugins/Film
        Name: film
"""


def test_the_table_says_of_each_piece_how_far_it_is_shown(
    parse: Callable[[str], RvizConfig],
):
    assert (
        config_report(parse(TEXT)).as_text()
        == """\
Global Options: shown
  Fixed Frame  map  shown

robots (rviz_common/Group), on: shown
  R (rviz_default_plugins/RobotModel), on: shown
    Mass Properties/Inertia  true  not supported
    Update Interval          0     approximated (live)
    Alpha                    0.3   shown
    Glow                           unknown key (kept in the file)

radar (my_plugins/Radar), off: not supported
  A display of my_plugins, not of RViz itself, which is not known here.
  its 1 properties are kept in the file

Current View (rviz_default_plugins/Orbit): shown
  Distance  3  shown

Saved views
  film                                      not supported

Tools
  rviz_default_plugins/Measure              shown
  rviz_default_plugins/Select               not supported

Panels of RViz, kept in the file: rviz_common/Displays

3 displays, 1 of them not supported
"""
    )


def test_the_json_holds_the_same_and_the_defaults(parse: Callable[[str], RvizConfig]):
    found = json.loads(json.dumps(config_report(parse(TEXT)).as_json()))
    assert found["file"] == "my.rviz"
    assert found["counts"] == {
        "shown": 1,
        "approximated": 1,
        "not supported": 2,
        "kept": 0,
        "unknown key": 1,
    }
    group, radar = found["displays"]
    (robot,) = group["displays"]
    rows = {row["path"]: row for row in robot["properties"]}
    assert rows["Alpha"] == {
        "path": "Alpha",
        "value": "0.3",
        "level": "shown",
        "note": "",
        "given": True,
    }
    assert rows["Visual Enabled"]["given"] is False
    assert rows["Glow"]["level"] == "unknown key"
    assert radar["note"].startswith("A display of my_plugins")
    assert robot["note"] == group["note"] == ""
    assert radar["properties"] == [
        {
            "path": "Range",
            "value": "9",
            "level": "not supported",
            "note": "kept in the file",
            "given": True,
        }
    ]
    assert found["panels"] == ["rviz_common/Displays"]
    assert found["problems"] == []


def test_names_with_control_characters_do_not_reach_the_terminal(
    parse: Callable[[str], RvizConfig],
):
    config = parse(
        'Visualization Manager:\n  Displays: [{Class: x/Y, Name: "a\\e[31m"}]\n'
    )
    assert "\x1b" not in config_report(config).as_text()


def test_every_real_file_has_a_report(
    real_files: list[Path], declarations: Declarations
):
    for path in real_files[::7]:
        report = config_report(RvizConfig.load(path, declarations))
        assert report.as_text()
        json.dumps(report.as_json())


OTHER_KEYS = """\
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/TF, Name: TF, Marker Alpha: 1, Tree: {map: {}}}
    - {Class: rviz_default_plugins/Axes, Name: A, Alpha: 1, Show Trail: false}
    - {Class: rviz/RobotModel, Name: R, Robot Description: robot_description}
    - {Class: rviz/LaserScan, Name: L, Topic: /scan, Queue Size: 10, Unreliable: false}
    - {Class: rviz_default_plugins/Grid, Name: G, Glow: 1}
  Global Options: {Fixed Frame: map, Default Light: true}
  Views:
    Current:
      Class: rviz_default_plugins/FPS
      Enable Stereo Rendering: {Stereo Eye Separation: 0.06, Value: false}
      Field of View: 0.785
      Roll: 0
"""


def test_keys_that_rviz_itself_writes_are_not_called_unknown():
    document = RvizConfig.parse(OTHER_KEYS, load_declarations())
    found = config_report(document)
    items = [found.global_options, *found.displays, found.view]
    rows = {row.path: row for item in items for row in item.properties if row.given}
    assert {path: rows[path].level for path in rows if path != "Fixed Frame"} == {
        "Tree": "kept",
        "Marker Alpha": "not supported",
        "Alpha": "not supported",
        "Show Trail": "not supported",
        "Robot Description": "approximated",
        "Topic": "shown",
        "Queue Size": "kept",
        "Unreliable": "kept",
        "Glow": "unknown key",
        "Default Light": "shown",
        "Enable Stereo Rendering": "kept",
        "Field of View": "not supported",
        "Roll": "not supported",
    }
    assert all(rows[path].note for path in rows if rows[path].level == "kept")
    assert document.to_yaml() == OTHER_KEYS


def test_a_property_of_ros_1_is_kept_in_a_file_of_ros_2():
    text = OTHER_KEYS.replace(" rviz/", " rviz_default_plugins/")
    document = RvizConfig.parse(text, load_declarations())
    rows = {row.path: row for row in config_report(document).global_options.properties}
    assert rows["Default Light"].level == "kept"
    assert rows["Default Light"].value == "true"


def test_a_key_that_is_only_kept_is_not_written_into_a_new_display():
    document = RvizConfig.parse(OTHER_KEYS, load_declarations())
    added = document.add_display("rviz_default_plugins/TF")
    assert "Tree" not in added.raw
    assert "Tree" not in added.properties
