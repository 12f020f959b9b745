"""The one table of limits for everything that comes from outside.

What is above a limit costs its own topic, file or page; the rest goes on, and a
sentence with the figures says it. docs/limits.md is made from this table.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class LimitRow:
    """A row of the table.

    Attributes:
        what: what is counted, and of which sources.
        value: the most that is taken.
        unit: of the value; "" for a plain number of what is counted.
        above: what becomes of the rest, and where that is said.
    """

    what: str
    value: int
    unit: str
    above: str

    def said(self, found: int) -> str:
        """Return the figures for a sentence: "900 bytes; the limit is 100"."""
        unit = f" {self.unit}" if self.unit else ""
        return f"{found:,}{unit}; the limit is {self.value:,}"


# recordings and live robots

MESSAGE = LimitRow(
    "a message of an mcap, db3 or bag file, and a frame of a live robot",
    256 * 2**20,
    "bytes",
    "it is left out without being read; its topic says so, and Problems or the status "
    "of the source. The connection is made again only after a message that came in "
    "several frames, or one of 16 times the size",
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
    "channels of a recording, and topics of a db3 file",
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

# what is drawn

IMAGE = LimitRow(
    "an image or a depth image",
    50_000_000,
    "pixels",
    "it is not unpacked; the display says so",
)
DEPTH_POINTS = LimitRow(
    "points of a DepthCloud",
    4_000_000,
    "",
    "the image is not drawn; the display says so",
)
MAP_CELLS = LimitRow(
    "cells of a map",
    100_000_000,
    "",
    "the map is not drawn; the display says so",
)
MESSAGE_POSES = LimitRow(
    "points or poses of a Path, PoseArray, Polygon or GridCells",
    100_000,
    "",
    "the message is not drawn; the display says so",
)
MARKERS = LimitRow(
    "markers of a display",
    20_000,
    "",
    "later ones are not drawn; the display says so",
)
MARKER_POINTS = LimitRow(
    "points of a marker",
    500_000,
    "",
    "the marker is not drawn; its row says so",
)
MARKERS_POINTS = LimitRow(
    "points of all markers of a display",
    2_000_000,
    "",
    "later markers are not drawn; the display says so",
)
INTERACTIVE_MARKERS = LimitRow(
    "interactive markers of a display",
    500,
    "",
    "later ones are not shown; the display says so",
)

# files of robots and configs

MODEL = LimitRow(
    "a URDF, SDF or xacro file",
    64_000_000,
    "bytes",
    "it is refused, with an error",
)
CONFIG = LimitRow(
    "an .rviz file",
    4_000_000,
    "bytes",
    "it is refused, with an error",
)
MESH = LimitRow(
    "a mesh file",
    500 * 2**20,
    "bytes",
    "the mesh is missing; Problems says so",
)
TRIANGLES = LimitRow(
    "triangles of a mesh file",
    20_000_000,
    "",
    "the mesh is missing; Problems says so",
)
TEXTURE = LimitRow(
    "the file of a texture",
    64 * 2**20,
    "bytes",
    "the mesh is drawn without it; Problems says so",
)
TEXTURE_PIXELS = LimitRow(
    "a texture",
    8192 * 8192,
    "pixels",
    "the mesh is drawn without it; Problems says so",
)

# pages

PAGES = LimitRow(
    "pages of one server",
    200,
    "",
    "the next one is told to come again later",
)
CONNECTIONS = LimitRow(
    "connections of one server",
    600,
    "",
    "the next one is closed at once",
)
PAGE_MESSAGE = LimitRow(
    "a message of a page",
    64 * 1024,
    "bytes",
    "the connection is closed, which is logged",
)
PAGE_TEXT = LimitRow(
    "a text that is typed in a page",
    1000,
    "characters",
    "it is not taken; the page says so",
)
TOPIC_ROWS = LimitRow(
    "rows of the Topics panel",
    200,
    "",
    "the last row says how many more there are; the search finds them",
)
PROBLEM_ROWS = LimitRow(
    "rows of the Problems panel",
    100,
    "",
    "the last row says how many more there are",
)
