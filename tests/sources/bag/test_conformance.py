"""The 416 files of the MCAP conformance suite are read message by message."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest
import yaml

from sambot_viz.sources.bag import mcap, open_bag


@pytest.mark.parametrize("small", [mcap.SMALL, 0])
def test_every_file_gives_its_messages(
    shared: Path, small: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also when it is too large to be read through at opening."""
    monkeypatch.setattr(mcap, "SMALL", small)
    folder = shared / "data" / "bags" / "mcap-conformance"
    text = (folder / "expected.yaml").read_text("utf-8")
    expected: dict[str, Any] = yaml.safe_load(text)
    assert len(expected["files"]) == 416
    for name, (content, *_) in expected["files"].items():
        want = expected["content"][content]
        with open_bag(folder / name) as bag:
            assert bag.is_complete
            found = [
                [m.topic, m.log_ns, m.publish_ns, sha256(m.payload).hexdigest()[:16]]
                for m in bag.messages()
            ]
            messages = [[m[0], m[1], m[2], m[4]] for m in want["messages"]]
            assert found == sorted(messages, key=lambda m: m[1]), name
            for channel in want["channels"]:
                topic = bag.topics[channel["topic"]]
                assert topic.message_encoding == channel["message_encoding"]
                assert topic.count == len(messages)
                if channel["schema_id"]:
                    (schema,) = want["schemas"]
                    assert topic.schema.name == schema["name"]
                    assert topic.schema.encoding == schema["encoding"]
            codes = [problem.code for problem in bag.problems]
            assert codes == ([] if messages else ["file-no-messages"]), name
