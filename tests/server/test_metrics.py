"""The counts of a server: what Prometheus finds at /metrics, and who may read it."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
from inside import viser_server
from live_peers import eventually
from prometheus_client.parser import text_string_to_metric_families
from protocol_client import ProtocolClient
from robot_peer import RobotPeer

from sambot_viz import UsageError, Visualizer

Protocol = Callable[..., ProtocolClient]
Counts = dict[tuple[str, tuple[str, ...]], float]


def answered(viz: Visualizer, token: str = "") -> str:
    """Return what the server answers."""
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    address = f"http://127.0.0.1:{viz.viser.get_port()}/metrics"
    with urlopen(Request(address, headers=headers)) as answer:
        assert answer.headers["Content-Type"].startswith("text/plain")
        return answer.read().decode()


def counts(viz: Visualizer, token: str = "") -> Counts:
    """Return the samples by name and values of the labels."""
    return {
        (sample.name, tuple(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(answered(viz, token))
        for sample in family.samples
    }


def test_a_page_and_what_it_was_sent_are_counted(
    make_viz: Callable[..., Visualizer], protocol: Protocol
) -> None:
    viz = make_viz(metrics=True)
    before = counts(viz)
    assert before["sambot_viz_pages", ()] == 0
    assert before["sambot_viz_sessions", ()] == 1

    client = protocol(viz.viser.get_port())
    client.settle(viser_server(viz))
    after = counts(viz)
    assert after["sambot_viz_pages", ()] == 1
    # Its own two, and that of the question.
    assert after["sambot_viz_connections", ()] == 3
    assert after["sambot_viz_sent_bytes_total", ()] > 10_000
    assert after["sambot_viz_sent_frames_total", ()] > 0
    assert after["sambot_viz_slowest_page_seconds", ()] == 0

    client.close()
    eventually(lambda: counts(viz)["sambot_viz_pages", ()] == 0)
    left = counts(viz)
    assert left["sambot_viz_connections", ()] == 1
    sent = "sambot_viz_sent_bytes_total", ()
    assert left[sent] >= after[sent], "what was sent to those that have left stays"


def test_the_counts_are_there_only_when_asked_for(
    make_viz: Callable[..., Visualizer],
) -> None:
    with pytest.raises(HTTPError) as refused:
        counts(make_viz())
    with refused.value as answer:
        assert answer.code == 404


def test_the_counts_are_behind_the_token(make_viz: Callable[..., Visualizer]) -> None:
    viz = make_viz(metrics=True, token="the-token-of-the-lab")
    with pytest.raises(HTTPError) as refused:
        counts(viz)
    with refused.value as answer:
        assert answer.code == 401
    assert counts(viz, "the-token-of-the-lab")["sambot_viz_pages", ()] == 0


def test_problems_are_counted_by_code(
    tmp_path: Path,
) -> None:
    model = tmp_path / "robot.urdf"
    model.write_text(
        "<robot name='a'><link name='base'><visual><geometry><mesh filename="
        "'package://nowhere/a.stl'/></geometry></visual></link></robot>"
    )
    found = ("sambot_viz_problems", ("mesh-not-found", "warning"))
    with Visualizer(model, port=0, metrics=True) as viz:
        eventually(lambda: counts(viz).get(found) == 1)


def test_a_source_is_counted_by_its_address_without_what_is_secret(
    peer: RobotPeer, make_viz: Callable[..., Visualizer]
) -> None:
    secret = peer.uri.replace("://", "://bob:password@") + "/?token=secret"
    viz = make_viz(source=secret, metrics=True)
    shown = f"{peer.uri}/"
    eventually(lambda: counts(viz)["sambot_viz_source_connected", (shown,)] == 1)
    labels = [one for _, several in counts(viz) for one in several]
    assert not any("password" in one or "secret" in one for one in labels)

    received = "sambot_viz_source_messages_total", (shown,)
    eventually(lambda: {"/tf", "/joint_states"} <= set(peer.subscribed()))
    before = counts(viz)[received]
    peer.play(1.0)
    eventually(lambda: counts(viz)[received] > before)


LABELS = {"code", "severity", "source", "version"}
"""All labels there are: what has none of them cannot name a person."""


@pytest.mark.parametrize("name", ["Ada Lovelace", 'x"} 1', "code=\\n", "ada\\"])
def test_no_name_of_a_person_and_no_secret_is_among_the_counts(
    make_viz: Callable[..., Visualizer], name: str
) -> None:
    secrets = {"token": "the-token-of-the-lab", "presenter": "the-secret-of-ada"}
    viz = make_viz(metrics=True, trust_user_header="X-User", **secrets)
    known = {"Authorization": f"Bearer {secrets['token']}", "X-User": name}
    with closing(ProtocolClient(viz.viser.get_port(), headers=known)) as client:
        client.settle(viser_server(viz))
        assert name in {row.get("name") for row in client.rows.values()}
        text = answered(viz, secrets["token"])
    assert "sambot_viz_pages 1.0" in text
    for secret in (*secrets.values(), name, name.split()[0], "X-User"):
        assert secret not in text
    families = text_string_to_metric_families(text)
    labels = {label for one in families for s in one.samples for label in s.labels}
    assert labels <= LABELS


def test_the_missing_library_is_named_with_its_installation(
    monkeypatch: pytest.MonkeyPatch, make_viz: Callable[..., Visualizer]
) -> None:
    find = importlib.util.find_spec
    monkeypatch.setattr(
        "sambot_viz.extras.find_spec",
        lambda name: None if name == "prometheus_client" else find(name),
    )
    with pytest.raises(UsageError, match='pip install "prometheus-client') as refused:
        make_viz(metrics=True)
    assert "--metrics needs the package prometheus-client" in str(refused.value)
