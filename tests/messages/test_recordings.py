"""All messages of all recordings of the collection are read as its index says."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import pytest
import yaml
from bag_messages import messages_of

from sambot_viz.errors import DecodeError
from sambot_viz.messages import Decoder, MessageTypes, Schema, TransformDecoder


@pytest.fixture(scope="module")
def types() -> MessageTypes:
    return MessageTypes()


@pytest.fixture(scope="module")
def made(shared: Path) -> Any:
    index = (shared / "data/bags/made/index.yaml").read_text("utf-8")
    return yaml.load(index, Loader=yaml.CSafeLoader)


def read(path: Path, types: MessageTypes) -> tuple[Any, Any, dict[str, Decoder]]:
    """How many messages of each topic there are, how many are read, and how."""
    came: Counter[str] = Counter()
    good: Counter[str] = Counter()
    decoders: dict[str, Decoder] = {}
    for topic, schema, encoding, payload in messages_of(path):
        decoder = decoders[topic] = types.decoder(schema, encoding)
        came[topic] += 1
        try:
            decoder.decode(payload)
        except DecodeError:
            continue
        assert decoder.reason is None
        good[topic] += 1
    return came, good, decoders


def test_the_messages_of_made_recordings_are_read(
    shared: Path, made: Any, types: MessageTypes
) -> None:
    whole = 0
    for name, facts in made.items():
        topics = facts.get("topics") or {}
        came, good, decoders = read(shared / "data/bags/made" / name, types)
        for topic, expected in topics.items():
            if "protobuf" in expected.get("why", ""):
                continue  # it is read since the list was made
            where = f"{name} {topic}"
            missing = expected["messages"] - expected["readable"]
            assert came[topic] - good[topic] <= missing, where
            if came[topic] == expected["messages"]:
                whole += 1
                assert good[topic] == expected["readable"], where
            if topic in decoders and (why := expected.get("why", "")):
                decoder = decoders[topic]
                assert (decoder.reason is None) == (expected["readable"] > 0), where
                assert (decoder.note is not None) == ("standard one" in why), where
    assert whole > 200


def test_reasons_say_what_the_index_wants_of_them(
    shared: Path, made: Any, types: MessageTypes
) -> None:
    wanted = {"encoding", "type-unknown", "definition-wrong"}
    said = 0
    for name, facts in made.items():
        says = facts.get("say") or []
        for say in says if isinstance(says, list) else [says]:
            if say["reason"] in wanted and "protobuf" not in say["words"]:
                topic = say["about"].removeprefix("topic ")
                decoder = read(shared / "data/bags/made" / name, types)[2][topic]
                reason = decoder.reason or decoder.note
                assert reason is not None and reason.code == say["reason"]
                assert all(word in reason.text for word in say["words"])
                said += 1
    assert said == 4


def test_the_messages_of_recordings_of_others_are_read(
    shared: Path, types: MessageTypes
) -> None:
    folder = shared / "data/bags/real"
    text = (folder / "expected.yaml").read_text("utf-8")
    files = yaml.load(text, Loader=yaml.CSafeLoader)["files"]
    for name, facts in files.items():
        came, good, decoders = read(folder / name, types)
        for topic, expected in facts["topics"].items():
            assert came[topic] == expected["messages"], f"{name} {topic}"
            assert good[topic] == expected["readable"], f"{name} {topic}"
            if topic in decoders:
                assert decoders[topic].type_name == expected["type"]


def test_a_folder_of_definitions_makes_unknown_types_readable(
    shared: Path, tmp_path: Path
) -> None:
    bag = shared / "data/bags/made/custom_type_humble"
    text = ""
    for _, schema, _, _ in messages_of(shared / "data/bags/made/custom_type.mcap"):
        if schema.name == "my_lab_msgs/msg/Gripper":
            assert isinstance(schema.text, str)
            text = schema.text
    gripper, _, _, finger = text.split("=" * 80 + "\n")
    folder = tmp_path / "my_lab_msgs"
    for given in (tmp_path, folder):
        (folder / "msg").mkdir(parents=True, exist_ok=True)
        (folder / "msg" / "Gripper.msg").write_text(gripper, "utf-8")
        types = MessageTypes([given])
        decoder = types.decoder(Schema("my_lab_msgs/msg/Gripper"), "cdr")
        assert decoder.reason is not None
        assert "no definition of my_lab_msgs/msg/Finger" in decoder.reason.text
        fields = finger.partition("\n")[2]
        (folder / "msg" / "Finger.msg").write_text(fields, "utf-8")
        came, good, _ = read(bag, MessageTypes([given]))
        assert good["/gripper"] == came["/gripper"] == 30
        (folder / "msg" / "Finger.msg").unlink()


def test_every_channel_of_the_conformance_suite_gets_a_decoder(
    shared: Path, types: MessageTypes
) -> None:
    folder = shared / "data/bags/mcap-conformance"
    schemas = {
        (schema, encoding)
        for path in sorted(folder.rglob("*.mcap"))[::20]
        for _, schema, encoding, _ in messages_of(path)
    }
    assert schemas
    for schema, encoding in schemas:
        assert isinstance(types.decoder(schema, encoding), Decoder)
    assert types.decoder(Schema(""), "").reason is not None


@pytest.mark.parametrize("name", ["made/square.mcap", "made/square.bag", "real"])
def test_both_decoders_read_the_same_transforms(
    shared: Path, types: MessageTypes, name: str
) -> None:
    path = shared / "data/bags" / name
    count, fast = 0, dict[str, TransformDecoder]()
    for _, schema, encoding, payload in messages_of(
        path / "example-bz2.bag" if name == "real" else path
    ):
        if not schema.name.lower().endswith("tfmessage"):
            continue
        message = types.decoder(schema, encoding).decode(payload)
        decoder = fast.setdefault(encoding, TransformDecoder(encoding))
        found = [
            (stamp, edge, tuple(pose))
            for stamp, edges, poses in decoder.decode(payload)
            for edge, pose in zip(edges, poses.tolist(), strict=True)
        ]
        assert sorted(found) == sorted(map(row, message.transforms))
        count += len(found)
    assert count > 1000


def row(one: Any) -> tuple[int, tuple[str, str], tuple[float, ...]]:
    """A transform as the other decoder gives it."""
    stamp = one.header.stamp.sec * 10**9 + one.header.stamp.nanosec
    place, turn = one.transform.translation, one.transform.rotation
    pose = (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
    return stamp, (one.header.frame_id, one.child_frame_id), pose
