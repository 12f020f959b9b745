"""Limits of what displays draw."""

from __future__ import annotations

from sambot_viz.limits.row import LimitRow

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
DISPLAY_WAITING = LimitRow(
    "messages of a display that wait between two pictures",
    100,
    "",
    "the newest ones are drawn",
)
FIRST_SIGHT = LimitRow(
    "topics that are shown without a config",
    24,
    "",
    "the panel Topics adds the others",
)
FIRST_PICTURES = LimitRow(
    "pictures of them",
    4,
    "",
    "the panel Topics adds the others",
)
MARKER_ROWS = LimitRow(
    "markers of a display with a status",
    100,
    "",
    "one row says that there are more",
)
MARKER_TEXT = LimitRow(
    "a text in the view",
    2000,
    "characters",
    "its beginning is drawn",
)
CONTROLS = LimitRow(
    "controls of an interactive marker",
    1000,
    "",
    "the interactive marker is not drawn; the display says so",
)
CONTROL_MARKERS = LimitRow(
    "markers of the controls of a display of interactive markers",
    2500,
    "",
    "later ones are not drawn; the display says so",
)
MENU_ENTRIES = LimitRow(
    "entries of the menu of an interactive marker",
    200,
    "",
    "it ends with a line that has how many more there are",
)
INTERACTIVE_UPDATES = LimitRow(
    "updates of interactive markers that are applied after a jump",
    10_000,
    "",
    "the newest ones count",
)
MAP_UPDATES = LimitRow(
    "updates of a map that are applied after a jump",
    2000,
    "",
    "the newest ones count",
)
PATHS = LimitRow(
    "paths of a Path",
    100,
    "",
    "the newest ones are drawn; the help of Buffer Length says so",
)
VECTORS = LimitRow(
    "arrows of a Wrench, Accel or Twist",
    100,
    "",
    "the newest ones are drawn; the help of History Length says so",
)
STAMPED_POINTS = LimitRow(
    "points of a PointStamped",
    10_000,
    "",
    "the newest ones are drawn; the help of History Length says so",
)
RANGE_CONES = LimitRow(
    "cones of a Range",
    1000,
    "",
    "the newest ones are drawn; the help of Buffer Length says so",
)
EFFORT_CIRCLES = LimitRow(
    "circles of an Effort",
    500,
    "",
    "the newest ones are drawn; the help of History Length says so",
)
ODOMETRY_POSES = LimitRow(
    "poses of an Odometry",
    10_000,
    "",
    "the newest ones are drawn; the help of Keep says so",
)
IMAGE_MEDIAN = LimitRow(
    "pictures that an Image normalizes by",
    1000,
    "",
    "the newest ones count",
)
IMAGES_WAITING = LimitRow(
    "pictures of a Camera that wait for their transform",
    10,
    "",
    "the newest ones wait",
)
GRID_LINES = LimitRow(
    "a Grid",
    100_000,
    "lines",
    "it is drawn with fewer cells; its status says how many",
)
SELECTED_BOXES = LimitRow(
    "selected points of a message with a box",
    10_000,
    "",
    "the first ones have it",
)
STATUS_TEXT = LimitRow(
    "a status of a display",
    20_000,
    "characters",
    "its beginning is shown",
)
KEY = LimitRow(
    "the name of a status or of a namespace of markers",
    400,
    "characters",
    "its beginning is shown; a namespace has no row",
)
NAMESPACES = LimitRow(
    "namespaces of markers of a display",
    1000,
    "",
    "later ones have no row",
)
MARKER_MESSAGES = LimitRow(
    "messages of markers between two pictures, or after a jump",
    10_000,
    "",
    "the newest ones are drawn; the display says so",
)
MARKER_BURST = LimitRow(
    "messages of markers between two pictures",
    1_000_000,
    "bytes",
    "the newest ones are drawn; the display says so",
)
MARKER_JUMP = LimitRow(
    "messages of markers after a jump",
    8_000_000,
    "bytes",
    "the newest ones are drawn; the display says so",
)
GRAPH_PARTS = LimitRow(
    "nodes and topics of a graph that is drawn",
    400,
    "",
    "the first ones are drawn, by their names; a line below the graph says so",
)
GRAPH_EDGES = LimitRow(
    "arrows of a graph that is drawn",
    1000,
    "",
    "the first ones are drawn; a line below the graph says so",
)
