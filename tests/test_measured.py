"""The tables of `python -m tests.benchmarks` say what was measured."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.benchmarks import __main__ as benchmarks
from tests.benchmarks.peers import report, results
from tests.benchmarks.peers.results import Results
from tests.benchmarks.peers.viewers import Found


def found(**values: list[float]) -> Found:
    return Found(dict(values))


def tree50() -> Results:
    kept = Results()
    kept.viewers["tree50"] = results.columns(
        {
            "sambot-viz": found(page=[0.5, 0.6, 0.7], cpu_one=[0.2], rest=[0.0]),
            "viser ViserUrdf": found(page=[1.1, 1.2, 1.3], rest=[0.0]),
            "rerun web viewer": found(page=[0.3], cpu_one=[0.4], rest=[0.5]),
        }
    )
    kept.ran("tree50", 120.0)
    return kept


def row(lines: list[str], title: str) -> list[str]:
    [line] = [line for line in lines if line.startswith(f"| {title}")]
    return [cell.strip() for cell in line.strip("|").split("|")][1:]


def test_a_table_has_medians_with_their_spread_and_ratios_and_the_best_is_bold() -> (
    None
):
    lines = list(report.lines(tree50()))
    assert row(lines, "command → page") == [
        "0.60 ± 0.10",
        "1.20 ± 0.10 (2×)",
        "**0.30 (0.5×)**",
    ]
    assert row(lines, "computing of a step of one") == ["**0.20**", "–", "0.40 (2×)"]
    assert row(lines, "computing at rest") == ["**0.0**", "**0.0**", "0.5"]


def test_the_short_table_has_what_the_readme_has_room_for() -> None:
    lines = list(report.short_table(tree50()))
    assert row(lines, "command → page") == ["0.60", "1.20", "**0.30**"]


def test_a_peer_that_is_ahead_is_named_with_both_values() -> None:
    assert list(report.ahead(tree50())) == [
        "- command → page opens [s]: rerun web viewer 0.30 against 0.60 (tree50)."
    ]


def test_what_is_kept_gives_the_same_tables_and_a_part_can_be_measured_again(
    tmp_path: Path,
) -> None:
    path = tmp_path / "kept" / "benchmarks.json"
    results.write(tree50(), path)
    again = results.read(path)
    assert list(report.for_docs(again)) == list(report.for_docs(tree50()))
    again.viewers["sam_bot"] = results.columns({"sambot-viz": found(page=[0.4])})
    again.ran("sam_bot", 60.0)
    results.write(again, path)
    assert set(results.read(path).viewers) == {"tree50", "sam_bot"}


def test_figures_of_only_some_viewers_are_not_kept(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit):
        benchmarks.main(["--docs", "--viewers", "viser_urdf"])
    assert "--docs needs all viewers" in capsys.readouterr().err
