"""What a release says of itself agrees, and its workflow takes only what is pinned."""

from __future__ import annotations

import re
from pathlib import Path

import yaml

from sambot_viz import __version__


def test_the_citation_has_the_version_and_the_words_of_the_package(
    repository: Path,
) -> None:
    cited = yaml.safe_load((repository / ".github" / "CITATION.cff").read_text("utf-8"))
    project = (repository / "pyproject.toml").read_text("utf-8")
    assert cited["version"] == __version__
    assert f'description = "{cited["abstract"]}"' in project
    assert f'license = "{cited["license"]}"' in project


def test_the_changelog_has_this_version_and_what_comes_next(repository: Path) -> None:
    text = (repository / "CHANGELOG.md").read_text("utf-8")
    headings = re.findall(r"^## (.*)$", text, re.MULTILINE)
    assert headings[0] == "Unreleased"
    assert headings[1].split()[0] == __version__
    assert text.partition(f"## {__version__} ")[2].count("\n") <= 120


def test_workflows_pin_their_actions_and_give_few_rights(repository: Path) -> None:
    for path in (repository / ".github" / "workflows").glob("*.yml"):
        text = path.read_text("utf-8")
        for action in re.findall(r"uses: (.*)", text):
            assert re.fullmatch(r"[\w./-]+@[0-9a-f]{40} # v[\d.]+", action), action
        assert yaml.safe_load(text)["permissions"] == {"contents": "read"}


def test_the_pythons_of_the_classifiers_are_those_that_are_tested(
    repository: Path,
) -> None:
    project = (repository / "pyproject.toml").read_text("utf-8")
    named = re.findall(r"Python :: (3\.\d+)\"", project)
    workflow = (repository / ".github" / "workflows" / "ci.yml").read_text("utf-8")
    tested = yaml.safe_load(workflow)["jobs"]["run"]["strategy"]["matrix"]["python"]
    assert named == tested
