"""The dashboard for Grafana asks for nothing that no server counts."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from live_peers import eventually
from prometheus_client.parser import text_string_to_metric_families
from robot_peer import RobotPeer, square_peer

from sambot_viz import Visualizer

NAME = re.compile(r"\b(?:sambot_viz|process)_\w+")


def counted(viz: Visualizer) -> set[str]:
    with urlopen(f"{viz.url}/metrics") as answer:
        families = text_string_to_metric_families(answer.read().decode())
        return {sample.name for family in families for sample in family.samples}


def asked(dashboard: Any) -> set[str]:
    """Names of all that the panels and the variables ask for."""
    panels = [t["expr"] for panel in dashboard["panels"] for t in panel["targets"]]
    variables = [str(one["query"]) for one in dashboard["templating"]["list"]]
    return {name for text in (*panels, *variables) for name in NAME.findall(text)}


def test_all_that_the_dashboard_asks_for_is_counted(
    repository: Path, make_viz: Callable[..., Visualizer]
) -> None:
    text = (repository / "deploy" / "grafana.json").read_text("utf-8")
    names = asked(json.loads(text))
    with square_peer(repository, RobotPeer) as peer:
        viz = make_viz(metrics=True, source=peer.uri)
        eventually(lambda: "sambot_viz_source_connected" in counted(viz))
        # Names with a sample only once there is a value.
        may_lack = {"sambot_viz_problems", "sambot_viz_source_lag_seconds"}
        assert names - counted(viz) <= may_lack
        own = {name for name in counted(viz) if name.startswith("sambot_viz_")}
    # What depends on the version of the program, or tells when counting has begun.
    own = {name for name in own if not name.endswith(("_info", "_created"))}
    assert own <= names, "the dashboard shows all that the program counts"


def test_panels_do_not_overlap_and_name_the_chosen_source(repository: Path) -> None:
    dashboard = json.loads((repository / "deploy" / "grafana.json").read_text("utf-8"))
    places = [
        (panel["gridPos"]["x"], panel["gridPos"]["y"]) for panel in dashboard["panels"]
    ]
    assert len({*places}) == len(places)
    assert {p["datasource"]["uid"] for p in dashboard["panels"]} == {"${source}"}
