"""Reasons that only a robot on the network has."""

from __future__ import annotations

from dataclasses import replace

import pytest

from sambot_viz.messages import Schema
from sambot_viz.sources.message import SourceTopic
from sambot_viz.sources.qos import Qos
from sambot_viz.topics import reasons
from sambot_viz.topics.reasons import SEVERITIES


def topic(publishers: tuple[str, ...] | int | None) -> SourceTopic:
    return SourceTopic("/scan", Schema("a/msg/B"), "cdr", publishers=publishers)


@pytest.mark.parametrize("publishers", [0, ()])
def test_a_topic_that_nobody_publishes_says_so(publishers: int | tuple[()]) -> None:
    reason = reasons.unreceived(topic(publishers))
    assert reason is not None and reason.code == "no-publisher"
    assert "ros2 topic info /scan" in reason.text


def test_a_topic_that_a_node_waits_for_names_it() -> None:
    wanted = replace(topic(()), subscribers=("/costmap", "/amcl"))
    reason = reasons.unreceived(wanted)
    assert reason is not None and reason.code == "awaited"
    assert "/costmap, /amcl wait for it" in reason.text


@pytest.mark.parametrize("publishers", [None, 1, ("/laser",)])
def test_a_topic_with_a_publisher_or_an_unknown_one_is_fine(
    publishers: tuple[str, ...] | int | None,
) -> None:
    assert reasons.unreceived(topic(publishers)) is None


@pytest.mark.parametrize(
    ("offered", "wanted", "words"),
    [
        (Qos("best_effort"), Qos("reliable"), ("Best Effort", "Reliable")),
        (
            Qos("reliable", "volatile"),
            Qos("reliable", "transient_local"),
            ("Volatile", "Transient Local", "Durability Policy"),
        ),
    ],
)
def test_qos_that_cannot_match_is_said_with_both_words(
    offered: Qos, wanted: Qos, words: tuple[str, ...]
) -> None:
    reason = reasons.qos_mismatch(offered, wanted)
    assert reason is not None and reason.code == "qos"
    assert all(word in reason.text for word in words)


@pytest.mark.parametrize(
    ("offered", "wanted"),
    [
        (None, Qos("reliable", "transient_local")),
        (Qos(), Qos("reliable", "transient_local")),
        (Qos("best_effort", "volatile"), Qos()),
        (Qos("reliable", "transient_local"), Qos("best_effort", "volatile")),
        (Qos("reliable", "transient_local"), Qos("reliable", "transient_local")),
    ],
)
def test_qos_that_matches_adapts_or_is_unknown_is_no_reason(
    offered: Qos | None, wanted: Qos
) -> None:
    assert reasons.qos_mismatch(offered, wanted) is None


def test_what_was_dropped_is_counted() -> None:
    assert reasons.lagging(0, "the network") is None
    reason = reasons.lagging(1234, "the network")
    assert reason is not None and "1,234 messages were dropped" in reason.text
    reason = reasons.lagging(1, "this program")
    assert reason is not None and "1 message was dropped" in reason.text
    assert reason.code in SEVERITIES
