"""Limits of what a page, and who opens one, may ask for."""

from __future__ import annotations

from sambot_viz.limits.row import LimitRow

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
    "the next one is told to come again later; probes of the state are answered",
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
COMPARE_ROWS = LimitRow(
    "rows of the Compare panel",
    200,
    "",
    "its note says how many there are",
)
PAGE_MESSAGES = LimitRow(
    "messages of a page",
    300,
    "in a second",
    "the others wait",
)
WRONG_TOKENS = LimitRow(
    "requests with a wrong token that are answered at once",
    20,
    "",
    "further requests are answered later",
)
PAGE_ID = LimitRow(
    "the name of a row in a message of a page",
    400,
    "characters",
    "the message is not taken",
)
EDITED_TEXT = LimitRow(
    "a file in the panel Model",
    1_000_000,
    "characters",
    "it is not shown, or what would make it longer is not taken; the panel says so",
)
CLASS_REQUEST = LimitRow(
    "the address and the headers of a request to a class",
    32 * 1024,
    "bytes",
    "its connection is closed",
)
CLASS_FOLDER = LimitRow(
    "the folder that is called after a student",
    60,
    "bytes",
    "the rest of the name is left out of it; a number may follow",
)
CLASS_STUDENTS = LimitRow(
    "students of a class",
    60,
    "",
    "the next one is told that the class is full",
)
HUB_STUDENTS = LimitRow(
    "students on the board of a hub",
    1000,
    "",
    "the first ones are shown; the board says so",
)
HUB_ANSWER = LimitRow(
    "an answer of a JupyterHub to the board",
    4 * 1024 * 1024,
    "bytes",
    "it is not read; the board says that the hub does not list its users",
)
CLASS_CONNECTIONS = LimitRow(
    "connections of one student of a class",
    40,
    "",
    "the next one is refused; two belong to each page",
)
CLASS_MESSAGE = LimitRow(
    "what a teacher writes to a class",
    300,
    "characters",
    "it is refused; the board says so",
)
EDITED_PIECE = LimitRow(
    "what is typed or pasted there, in a message of a page",
    10_000,
    "characters",
    "the page sends several messages",
)
EDITED_FILES = LimitRow(
    "files in the panel Model",
    200,
    "",
    "the others have no tab",
)
PAGE_LIST = LimitRow(
    "a list in a message of a page",
    4000,
    "",
    "it is not taken; the page says so",
)
SESSION_DISPLAYS = LimitRow(
    "displays that a page adds",
    100,
    "",
    "it is refused; the page says so",
)
SESSION_FRAMES = LimitRow(
    "static transforms that a page adds",
    200,
    "",
    "it is refused; the page says so",
)
SESSION_VIEWS = LimitRow(
    "views that a page saves",
    100,
    "",
    "it is refused; the page says so",
)
SESSION_POSES = LimitRow(
    "poses that a page saves",
    100,
    "",
    "it is refused; the page says so",
)
POSE_NAME = LimitRow(
    "the name of a pose",
    60,
    "characters",
    "it is refused; the page says so",
)
PERSON_NAME = LimitRow(
    "the name of a person",
    40,
    "characters",
    "it is refused; the page says so",
)
CONFIG_NAME = LimitRow(
    "the name of a config",
    200,
    "bytes",
    "it is refused; the page says so",
)
CONFIG_NAMES = LimitRow(
    "configs of a folder",
    1000,
    "",
    "the first are listed, and none is added; the page says so",
)
INDEXED_ROBOTS = LimitRow(
    "robots of a router in an index",
    1000,
    "",
    "the first are listed; the page says so",
)
RECORDING_NAMES = LimitRow(
    "recordings that a page can open",
    1000,
    "",
    "the first of their folders are listed",
)
UNDO = LimitRow(
    "steps that a page can undo",
    200,
    "",
    "the oldest ones are forgotten",
)
UNDO_PAGES = LimitRow(
    "pages that have left, and may come again to their undo",
    50,
    "",
    "those that left first are forgotten",
)
ADDED_ROWS = LimitRow(
    "topics of the dialog Add",
    200,
    "",
    "the last row says how many more there are; the search finds them",
)
STEP_TOPICS = LimitRow(
    "topics that the player steps by",
    300,
    "",
    "the others are not offered",
)
LOGGED = LimitRow(
    "different internal errors in the log",
    100,
    "",
    "further ones are shown in the page alone",
)
PICTURE_SIDE = LimitRow(
    "a side of a picture",
    8192,
    "pixels",
    "it is refused, with an error",
)
MOTION = LimitRow(
    "a motion in an exported page",
    1200,
    "seconds",
    "it is refused, with an error",
)
EXPORTED_RECORDING = LimitRow(
    "what an exported page plays of a recording",
    300,
    "seconds",
    "the rest is left out; the command says from where",
)
EXPORTED_PAGE = LimitRow(
    "an exported page that a page asks for",
    100_000_000,
    "bytes",
    "it is refused; the page says so",
)
PAGE_PICTURE = LimitRow(
    "a side of a picture that a page asks for",
    4096,
    "pixels",
    "it is refused; the page says so",
)
PAGE_NUMBER = LimitRow(
    "a number in a message of a page",
    10**12,
    "",
    "it is not taken; the page says so",
)
VIEW_SIDE = LimitRow(
    "a side of a page's 3D view",
    100_000,
    "pixels",
    "nothing is picked in it",
)
NOTEBOOK_TRIANGLES = LimitRow(
    "triangles of a robot in a saved notebook",
    2_000_000,
    "",
    "the notebook keeps no picture",
)
NOTEBOOK_MESSAGE = LimitRow(
    "a message that JupyterLab passes on",
    50 * 2**20,
    "bytes",
    "the connection ends, which the page says",
)
