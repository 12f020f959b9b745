"""Limits of recordings and live robots."""

from __future__ import annotations

from sambot_viz.limits.row import LimitRow

MESSAGE = LimitRow(
    "a message of an mcap, db3 or bag file, and of a live robot",
    256 * 2**20,
    "bytes",
    "it is left out without being read; its topic says so, and Problems or the "
    "status of the source",
)
CHUNK = LimitRow(
    "a chunk of an mcap file or a bag, as it stands in the file and decompressed",
    256 * 2**20,
    "bytes",
    "it is left out without being decompressed; its topics and Problems say so",
)
SUMMARY = LimitRow(
    "the index at the end of an mcap file",
    256 * 2**20,
    "bytes",
    "the file is read without it",
)
DEFINITION = LimitRow(
    "the definition of a type of messages",
    2**20,
    "characters",
    "its topics say that they cannot be decoded",
)
DEFINITIONS = LimitRow(
    "all definitions of a db3 file together",
    64 * 2**20,
    "characters",
    "later ones are not read; topics of types that ROS does not have say so",
)
DEFINITION_TYPES = LimitRow(
    "types in the definition of a type",
    1000,
    "",
    "its topics say that they cannot be decoded",
)
DEFINITION_FIELDS = LimitRow(
    "fields of a type, with those of the types in it",
    5000,
    "",
    "its topics say that they cannot be decoded",
)
FIELDS_MESSAGE = LimitRow(
    "a message in JSON, Protobuf, FlatBuffers, CBOR or MessagePack",
    64 * 2**20,
    "bytes",
    "it is not decoded; its topic says so",
)
CHANNELS = LimitRow(
    "channels of a recording, topics of a db3 file, definitions of a topic over zenoh",
    65_536,
    "",
    "later ones are left out; Problems says so",
)
TOPICS = LimitRow(
    "topics of a live robot",
    20_000,
    "",
    "later ones are left out; the status of the source says so",
)
ENDPOINTS = LimitRow(
    "nodes, publishers, subscribers and services of a robot over zenoh or DDS",
    100_000,
    "",
    "later ones are left out",
)
FRAMES = LimitRow(
    "TF frames that messages bring",
    2000,
    "",
    "the first ones are shown; Problems names the first that is left out",
)
POSES = LimitRow(
    "poses of all frames that are kept, about ten seconds of them",
    4_000_000,
    "",
    "older ones are forgotten earlier",
)
LATCHED = LimitRow(
    "transforms and descriptions that hold at all times of a recording",
    32 * 2**20,
    "bytes",
    "later ones are not kept; each is found when its time comes",
)
LATCHED_OTHERS = LimitRow(
    "other latched messages of a recording",
    16 * 2**20,
    "bytes",
    "none of them is kept; each is found when its time comes",
)
SURVEYED = LimitRow(
    "messages that are looked at to say why a topic shows nothing",
    20_000,
    "",
    "the first ones speak for the others",
)
SURVEYED_BYTES = LimitRow(
    "what these messages hold together",
    50_000_000,
    "bytes",
    "the first ones speak for the others",
)
WAITING = LimitRow(
    "messages of a live topic that wait for this program",
    1024,
    "",
    "the oldest of the topic are dropped; the status of the source says how many",
)
SESSION_WAITING = LimitRow(
    "messages of transforms and joints that wait for a session",
    20_000,
    "",
    "the oldest are dropped; the status of the source says how many",
)
WAITING_BYTES = LimitRow(
    "what such messages hold together, of a source and of a session",
    128 * 2**20,
    "bytes",
    "the oldest are dropped; the status of the source says how many",
)
ASSET = LimitRow(
    "files of meshes that are kept of a live robot, together",
    256 * 2**20,
    "bytes",
    "those that came first are forgotten, and asked for again when they are needed",
)
RECORDING_WAITS = LimitRow(
    "what waits to be written by Record",
    64 * 2**20,
    "bytes",
    "messages are left out of the file, and counted",
)
BAG_HEADER = LimitRow(
    "the header of a record of a ROS 1 bag",
    2**20,
    "bytes",
    "the file is read up to there, and from the next chunk on; Problems says so",
)
DEFINITION_RECORD = LimitRow(
    "the record of a channel or a type in an mcap file or a bag",
    2**26,
    "bytes",
    "the record is left out; Problems says so, and topics whose type is not known",
)
RECORDING_FILES = LimitRow(
    "files of the folder of a recording",
    10_000,
    "",
    "the others are not opened, with a warning",
)
WEB_PIECES = LimitRow(
    "what is kept on the disk of a recording on a web server",
    2**31,
    "bytes",
    "it is forgotten, and asked for again when it is needed",
)
FOLLOWED_PART = LimitRow(
    "a file of a recording that is followed on a web server",
    2**30,
    "bytes",
    "the file is left out; the status says how many are",
)
METADATA = LimitRow(
    "metadata.yaml of a recording",
    2**24,
    "bytes",
    "the rest of it is not read; the files of the folder count",
)
QOS = LimitRow(
    "the offered QoS profiles of a topic",
    20_000,
    "characters",
    "the first profiles count",
)
DEFINITION_ARRAYS = LimitRow(
    "texts and values of other types in the fixed arrays of a type",
    1000,
    "",
    "its topics say that they cannot be decoded",
)
DEFINITION_EMPTY = LimitRow(
    "values of a type without a byte in the message",
    64,
    "",
    "its topics say that they cannot be decoded",
)
DEFINITION_DEPTH = LimitRow(
    "types in types of a definition",
    50,
    "",
    "its topics say that they cannot be decoded",
)
FIELDS_DEPTH = LimitRow(
    "values in values of a message in CBOR or FlatBuffers",
    32,
    "",
    "it is not decoded; its topic says so",
)
FLAT_SHARED = LimitRow(
    "how often the parts of a message in FlatBuffers are read, by its size",
    16,
    "times",
    "it is not decoded; its topic says so",
)
POINT_BYTES = LimitRow(
    "a point or a cell of a foxglove.PointCloud or Grid",
    2**16,
    "bytes",
    "the message is not drawn; the display says so",
)
SURVEYED_DECODED = LimitRow(
    "messages of a topic that are decoded to say why it shows nothing",
    30,
    "",
    "the first ones speak for the others",
)
SURVEYED_LATE = LimitRow(
    "topics that begin late, of which the first message is looked for",
    200,
    "",
    "of the others nothing is said",
)
SEARCHED = LimitRow(
    "messages that are looked at to find a frame, or a joint, that must be there",
    20_000,
    "",
    "a frame is not there, and a joint is at its start; Problems says so",
)
REPAIRED = LimitRow(
    "places in a damaged mcap file that look like a record",
    200_000,
    "",
    "what comes behind is left out; Problems says so",
)
LATCHED_KEPT = LimitRow(
    "messages of a latched topic of a live robot for displays that come later",
    1000,
    "",
    "the newest ones are kept",
)
ASSETS_AT_ONCE = LimitRow(
    "files of meshes that a live robot is asked for at once",
    4,
    "",
    "the others wait",
)
ASSET_NAME = LimitRow(
    "the address of a mesh in a message or a description",
    4000,
    "characters",
    "the mesh is missing; its marker or Problems says so",
)
ASSETS = LimitRow(
    "meshes of a described robot that a live robot is asked for",
    500,
    "meshes",
    "later ones are missing; Problems says so",
)
CALLS = LimitRow(
    "questions to rosapi that wait for an answer",
    50,
    "",
    "the publishers of further topics are not known",
)
RECORDING_MESSAGES = LimitRow(
    "messages that wait to be written by Record",
    100_000,
    "",
    "messages are left out of the file, and counted",
)
RECORDING_CHANNELS = LimitRow(
    "channels of a file that is written by Record",
    65_535,
    "",
    "later ones are left out of the file, and counted",
)
PEER_LINES = LimitRow(
    "sentences of a Foxglove server about itself",
    100,
    "",
    "later ones are not kept",
)
