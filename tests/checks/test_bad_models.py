from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz.checks import check

# The word that names the cause, and the code, for each entry of index.yaml.
CAUSES = {
    "robot-closed-too-early.urdf.xacro": ("too early", "xml-root-closed-early"),
    "comment-before-xml-declaration.urdf": ("comment", "xml-declaration-not-first"),
    "blank-line-before-xml-declaration.urdf": (
        "empty line",
        "xml-declaration-not-first",
    ),
    "tag-not-closed.urdf": ("arm_link", "xml-tag-not-closed"),
    "tag-case-mismatch.urdf": ("capital", "xml-tag-case"),
    "attribute-without-quotes.urdf": ("no quotes", "xml-quotes-missing"),
    "curly-quotes.urdf": ("curly", "xml-quotes-curly"),
    "double-hyphen-in-comment.urdf": ('"--"', "xml-comment-double-hyphen"),
    "unescaped-ampersand.urdf": ("&", "xml-ampersand"),
    "xacro-namespace-missing.urdf.xacro": ("not declared", "xml-prefix-undeclared"),
    "xacro-given-as-plain-urdf.urdf": ("contains xacro", "xacro-in-urdf"),
    "xacro-prefix-forgotten.urdf.xacro": ("prefix", "xacro-prefix-forgotten"),
    "xacro-undefined-property.urdf.xacro": ("wheel_radus", "xacro-undefined-name"),
    "xacro-property-after-use.urdf.xacro": ("line 5", "xacro-property-after-use"),
    "xacro-macro-parameter-missing.urdf.xacro": ("side", "xacro-parameter-missing"),
    "xacro-unknown-macro.urdf.xacro": ("wheell", "xacro-unknown-macro"),
    "xacro-find-unknown-package.urdf.xacro": (
        "sam_bot_description",
        "xacro-package-not-found",
    ),
    "xacro-include-missing.urdf.xacro": ("wheels.xacro", "xacro-include-missing"),
    "xacro-warning-stops-launch.urdf.xacro": ("pi", "xacro-warning"),
    "colon-in-comment-stops-launch.urdf": ('": "', "launch-text-as-yaml"),
    "two-root-links.urdf": ("arm_link", "root-not-unique"),
    "child-link-misspelt.urdf": ("whell_link", "joint-child-unknown"),
    "parent-link-undefined.urdf": ("chassis", "joint-parent-unknown"),
    "duplicate-link.urdf": ("line 16", "link-duplicate"),
    "duplicate-joint.urdf": ("line 26", "joint-duplicate"),
    "link-with-two-parents.urdf": ("z_extra_joint", "link-two-parents"),
    "cycle-without-root.urdf": ("ring", "joint-ring"),
    "cycle-beside-root.urdf": ("ring", "joint-ring"),
    "joint-to-itself.urdf": ("itself", "joint-to-itself"),
    "revolute-without-limit.urdf": ("no <limit>", "limit-missing"),
    "limit-without-effort.urdf": ("effort", "limit-incomplete"),
    "limit-without-lower-upper.urdf": ("lower", "limit-without-range"),
    "limit-reversed.urdf": ("greater", "limit-reversed"),
    "limit-in-degrees.urdf": ("degrees", "limit-in-degrees"),
    "rpy-in-degrees.urdf": ("degrees", "rpy-in-degrees"),
    "unknown-joint-type.urdf": ("hinge", "joint-type-unknown"),
    "joint-without-type.urdf": ("no type", "joint-without-type"),
    "parent-written-as-text.urdf": ("text", "joint-parent-without-link"),
    "origin-with-commas.urdf": ("commas", "number-malformed"),
    "origin-two-numbers.urdf": ("2 numbers", "number-malformed"),
    "expression-without-xacro.urdf": ("pi/2", "number-malformed"),
    "axis-zero.urdf": ("no direction", "axis-zero"),
    "axis-without-xyz.urdf": ("no xyz", "axis-without-xyz"),
    "mimic-unknown-joint.urdf": ("shoulder_joint", "mimic-joint-unknown"),
    "mimic-cycle.urdf": ("each other", "mimic-ring"),
    "root-link-with-inertia.urdf": ("KDL", "inertia-on-root"),
    "box-two-numbers.urdf": ("2 numbers", "number-malformed"),
    "cylinder-with-height.urdf": ("length", "cylinder-height"),
    "unknown-geometry.urdf": ("capsule", "geometry-capsule"),
    "mesh-package-missing.urdf": ("sam_bot_description", "mesh-not-found"),
    "mesh-scale-single-number.urdf": ("1 number", "number-malformed"),
    "material-undefined.urdf": ("blue", "material-undefined"),
    "color-0-255.urdf": ("0 to 255", "color-range"),
    "color-three-numbers.urdf": ("3 numbers", "color-count"),
    "material-name-reused.urdf": ("grey", "material-redefined"),
    "material-without-name.urdf": ("no name", "material-without-name"),
    "no-links.urdf": ("no links", "robot-without-links"),
    "links-inside-group.urdf": ("<group>", "links-not-direct"),
    "robot-without-name.urdf": ("no name", "robot-without-name"),
    "robot-version-2.urdf": ("2.0", "robot-version"),
    "link-without-name.urdf": ("arm_link", "link-without-name"),
    "frame-name-with-slash.urdf": ("slash", "link-name-slash"),
}

SDF = "root-element-is-sdf.sdf"
"""An error for tools that know URDF only; it is shown as robot_state_publisher does."""


# joint_state_publisher leaves this one joint out; it does not refuse the model.
SEVERITIES = {"limit-without-lower-upper.urdf": "warning"}


@cache
def entries(shared: Path) -> dict[str, dict[str, Any]]:
    text = (shared / "data" / "bad-models" / "index.yaml").read_text("utf-8")
    listed: list[dict[str, Any]] = yaml.safe_load(text)["models"]
    return {str(entry["file"]): entry for entry in listed}


def test_every_model_of_the_collection_is_expected_here(shared: Path) -> None:
    models = {name for name in entries(shared) if "/" not in name and "(" not in name}

    assert models == {*CAUSES.keys(), SDF}


@pytest.mark.parametrize("name", CAUSES)
def test_a_bad_model_is_explained_with_its_cause_its_line_and_its_fix(
    shared: Path, name: str
) -> None:
    entry = entries(shared)[name]
    word, code = CAUSES[name]

    problems = check(shared / "data" / "bad-models" / name)

    problem = next(p for p in problems if p.code == code)
    severity = SEVERITIES.get(name, entry["severity"])
    assert problem.severity == severity
    assert problem.line is not None
    assert abs(problem.line - entry["line"]) <= 1
    assert word in problem.message
    assert problem.hint
    assert problem.file is not None
    assert problem.file.endswith(name)
    if severity != "error":
        assert not any(p.severity == "error" for p in problems)


@pytest.mark.parametrize("name", ["_good.urdf", "_good.urdf.xacro", SDF])
def test_a_good_model_has_no_problems(shared: Path, name: str) -> None:
    assert check(shared / "data" / "bad-models" / name) == []


def test_the_first_seed_names_the_line_where_its_robot_ends_too_early(
    shared: Path,
) -> None:
    model = shared / "data" / "seed" / "robot_closed_too_early.urdf.xacro"

    (problem,) = check(model)

    assert problem.code == "xml-root-closed-early"
    assert problem.message.startswith("line 4 closes </robot> too early")
    assert problem.line == 4
    assert problem.hint == "move </robot> from line 4 to the last line of the file"
