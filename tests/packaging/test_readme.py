"""README names two commands for a fresh machine, and these are the ones that are run.

The first is run as it stands by tests/packaging/try_readme.py, in every whole run. The
second is what continuous integration runs.
"""

from __future__ import annotations

from pathlib import Path

from readme import commands


def test_the_second_command_is_what_continuous_integration_runs(
    repository: Path,
) -> None:
    _, test = commands(repository / "README.md")
    words = test.split()
    assert words[0] == "bash" and (repository / words[1]).is_file()
    last = repository.joinpath(".ci", "run").read_text("utf-8").splitlines()[-1]
    assert last == f"exec {test}"
    workflow = repository / ".github" / "workflows" / "ci.yml"
    assert f"- run: {test}\n" in workflow.read_text("utf-8")


def test_the_first_command_is_run_as_it_stands(repository: Path) -> None:
    show, _ = commands(repository / "README.md")
    assert "\n" not in show and show.startswith("python3 -m venv ")
    # A port that another program may have would make it fail.
    assert show.endswith(" --port 0")
    script = repository.joinpath("tests", "run").read_text("utf-8")
    assert "tests/packaging/try_readme.py" in script
