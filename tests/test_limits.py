"""The table of limits is complete, and each row of it is kept."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from docs_parts import limits_page

import sambot_viz

SOURCES = Path(sambot_viz.__file__).parent
_LIMIT = re.compile(
    r"(?:^|_)(?:MOST|LARGEST|LONGEST|MAX|MAXIMUM|DEEPEST|WIDEST|LIMIT)(?:_|$)"
)

NO_LIMITS = {
    "said: the rest of a sentence, a list or a row is cut or counted": """
        commands/topics.py _WIDEST
        displays/robot_model/balance_facts.py _MOST_NAMES
        displays/robot_model/robot_entries.py _MOST_NAMES
        errors.py _LONGEST_SENTENCE
        export/page_file.py LONGEST_NAME
        graph/labels.py _LONGEST
        messages/shape.py _WIDEST_TEXT
        panels/joints/joint_rows.py LARGEST_GROUP
        panels/permalink/permalink_parts.py MOST_NAMED
        panels/problems/problems_panel.py _LONGEST_FILE
        panels/compare_panel.py _LONGEST_NAME
        panels/problems/status_rows.py MOST_NAMES _LONGEST_SENTENCE _LONGEST_NAME
        panels/rows/row.py LONGEST_NAME LONGEST_TEXT
        problems.py MOST _LONGEST_LINE
        robot/sdf/gazebo_only.py _MOST_NAMES
        robot/sdf/the_model.py _MOST_MODELS
        robot/packages/package_index.py _MOST_NAMED
        robot/slips/follow_ups.py _MOST
        robot/xml/diagnose/explain_xml.py _MOST
        robot/xml/diagnose/lexer.py MOST_ERRORS
        robot/xml/diagnose/structure.py _MOST
        rviz/support_report.py _WIDEST
        session/model_edits.py _LONGEST_NAME _MOST_LINES
        session/own_config.py MOST_NAMES
        session/people/roles.py _LONGEST_LOGIN
        sources/bag/left_out.py _MOST_NAMED
        sources/foxglove.py _MOST_NOTES
        sources/joined.py _MOST_NAMED
        sources/live/conversation.py _MOST_LARGE _MOST_SAID
        topics/contents/clouds.py _MOST_NAMED
        topics/ends.py MOST_ENDS _WIDEST
    """,
    "time: how long something is waited for, lasts or is kept": """
        classroom/student_page.py LONGEST
        classroom/seat_process.py _LONGEST_START _LONGEST_END
        commands/command_line.py LONGEST_LISTEN
        displays/data/message_filter.py LONGEST_WAIT_NS
        export/page_file.py LONGEST_PAST
        export/recorded_scene.py LONGEST_READ
        export/view_picture.py LONGEST_WAIT
        files.py _LONGEST_SAVE
        options.py LONGEST_SLOT LONGEST_PART
        robot/fork_server.py _LONGEST_END
        joints/animation.py LONGEST
        publishing/dead_mans_switch.py LONGEST_STOP
        server/followers/follower.py LONGEST_ANSWER
        server/followers/link.py _LONGEST_END
        server/watch.py LONGEST_WAIT _LONGEST_CLOSE
        session/data/player.py LONGEST_STEP
        session/robot/motion.py LONGEST_STEP
        session/robot/motion_recorder.py LONGEST
        session/worker.py LONGEST_STOP
        sources/follow/followed_recording.py LONGEST_GAP
        sources/recording_file.py LONGEST_PERIOD
        sources/recording_thread.py LONGEST_STOP
        sources/rosapi.py LONGEST_ANSWER
        sources/live/service_calls.py LONGEST_ANSWER
        sources/live/assets.py LONGEST_FETCH
        sources/live/delivery.py LONGEST_STOP
        sources/websocket/runner.py LONGEST_SILENCE
        sources/live/live_source.py LONGEST_PAUSE LONGEST_STOP
        sources/dds/dds_source.py LONGEST_SEARCH
        sources/zenoh/readings.py _LONGEST_PAUSE
        sources/dds/ends.py _LONGEST_WRITE
        sources/dds/participant.py LONGEST_STOP
        sources/zenoh/session.py LONGEST_OPENING _LONGEST_TELLING
    """,
    "work: what is kept to be quick, or for how long a quick way is taken": """
        classroom/classroom.py MOST_PROCESSES
        classroom/seat_process.py _LONGEST_LINE
        displays/robot_model/link_overlays.py MOST_ELEMENTS
        displays/scene/lines.py MOST_PIECES
        frames/frame_tree.py _SEEN_LIMIT
        frames/samples.py MOST_GROUPS
        checks/around/xacro_arguments.py _MOST
        lab/robots.py _LONGEST
        messages/definition_text.py _LONGEST_WITHOUT_COMMENTS
        messages/flat_types.py _MOST_LEAVES
        messages/kept_elements.py MOST_BYTES _WIDEST
        messages/protobuf_transforms.py _LARGEST _LONGEST_VARINT
        messages/templates.py _MOST_KEYS _MOST_OF_A_KEY _MOST_BYTES
        messages/transform_decoder.py _MOST_KEPT _LARGEST_TEMPLATE
        server/followers/follower.py MOST_WAITING MOST_BEHIND
        server/tickets.py _MOST_REMOVED
        session/robot/motion_recorder.py MOST_NUMBERS
        sources/bag/file_bytes.py _MOST_AHEAD
        sources/cut_recording.py _MOST_GIVEN_UP
        sources/dds/participant.py _MOST_ENDPOINTS _MOST_KEPT
        sources/dds/settings.py _MOST_PARTICIPANTS
        tools/picking/pixel_rays.py MOST_PIXELS
        topics/decoding.py _MOST_KEPT
        topics/frame_limit.py _MOST_KEPT
        topics/joint_states.py _MOST_TEMPLATES
        topics/name_spaces.py _MOST_KEPT
        topics/heard.py _MOST_TIMES
        sources/zenoh/readings.py _MOST_WAITING
    """,
    "search: where advice and files are looked for": """
        checks/around/files/python_repair.py _MOST_LINES
        checks/targets.py _MOST_MODELS
        commands/fix.py _MOST_ROUNDS
        displays/robot_model/description_file.py MOST_LEVELS MOST_PARTS
        meshes/named_files.py _MAX_UP
        robot/packages/package_index.py _MAX_UP
        checks/consequences.py _MOST
        checks/proven.py _MOST
        checks/proven_around.py _MOST
        checks/model/rewritten.py _DEEPEST
        robot/xacro/at_calls.py _DEEPEST
        robot/xacro/diagnose/failing_values.py _DEEPEST
        robot/xacro/diagnose/text_for_number.py _DEEPEST
        sources/recorder.py _MOST_NAMES
    """,
    "meaning: a number of ROS, of a check, of a type or of what moves": """
        checks/around/files/parameters.py _MOST_NAMES
        checks/model/proportion.py _MOST
        checks/model/slips.py _SMALLEST_LIMIT _LARGEST_LIMIT
        displays/data/interactive_markers/controls.py LARGEST
        frames/history.py _DEEPEST
        panels/drive_panel.py MOST_LINEAR MOST_ANGULAR
        robot/balance/ground.py LARGEST_GAP
        robot/parts.py _NO_LIMIT
        robot/urdf/write_urdf.py _NO_LIMIT
        rviz/properties/number_text.py INT_LIMIT
        server/protection/inbound_filter.py _LARGEST_INT
    """,
}
"""Constants that are named like limits, and bound nothing that comes from outside."""


def _has_numbers(node: ast.expr | None) -> bool:
    match node:
        case ast.Constant(value=int() | float()):
            return True
        case ast.UnaryOp(operand=one):
            return _has_numbers(one)
        case ast.BinOp(left=left, right=right):
            return _has_numbers(left) and _has_numbers(right)
        case ast.Tuple(elts=parts):
            return any(map(_has_numbers, parts))
        case _:
            return False


def _named(target: ast.expr) -> Iterator[str]:
    for one in target.elts if isinstance(target, ast.Tuple) else [target]:
        if isinstance(one, ast.Name) and _LIMIT.search(one.id):
            yield one.id


def _written_as_numbers(text: str) -> Iterator[str]:
    """Yield the constants of a module that are named like limits."""
    for node in ast.parse(text).body:
        match node:
            case ast.Assign(targets=targets, value=value) if _has_numbers(value):
                for target in targets:
                    yield from _named(target)
            case ast.AnnAssign(target=target, value=value) if _has_numbers(value):
                yield from _named(target)


def _known() -> set[tuple[str, str]]:
    lines = (line.split() for group in NO_LIMITS.values() for line in group.split("\n"))
    return {(line[0], name) for line in lines if line for name in line[1:]}


def test_every_limit_of_what_comes_from_outside_is_a_row_of_the_table() -> None:
    found: set[tuple[str, str]] = set()
    for path in SOURCES.rglob("*.py"):
        module = path.relative_to(SOURCES).as_posix()
        if not module.startswith("limits/"):
            names = _written_as_numbers(path.read_text("utf-8"))
            found.update((module, name) for name in names)
    assert found - _known() == set(), "make it a row of sambot_viz.limits"
    assert _known() - found == set(), "these are gone"


def test_a_limit_is_found_however_it_is_written() -> None:
    text = "MOST = 3\n_LARGEST_A: int = 2**20\nA, LONGEST_B = 1, -2.0\nALMOST = 1\n"
    assert list(_written_as_numbers(text)) == ["MOST", "_LARGEST_A", "LONGEST_B"]


def test_every_row_is_used() -> None:
    text = "".join(p.read_text("utf-8") for p in SOURCES.rglob("*.py"))
    used = set(re.findall(r"\b(?:limits|table)\.([A-Z_]+)\b", text))
    assert used == set(limits_page.rows()), "a row that nothing is counted against"
