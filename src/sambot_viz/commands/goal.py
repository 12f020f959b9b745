"""``sambot-viz goal``: send a robot on the network somewhere, as 2D Goal Pose does."""

from __future__ import annotations

import argparse
from contextlib import closing

from sambot_viz.commands.command_line import Parser, parse
from sambot_viz.errors import UsageError
from sambot_viz.files import LIVE_SOURCES
from sambot_viz.listened import CONNECTED_WITHIN
from sambot_viz.moved_by import open_moved_by, refuse_mixture, refuse_time_of_live
from sambot_viz.outlet import write_lines
from sambot_viz.publishing.goal_sender import GoalSender
from sambot_viz.publishing.outbound import GOAL_TOPIC, MAP, Goal, NavGoal
from sambot_viz.text import text

WAIT = 120.0
"""The time limit for following a goal [s]."""
FARTHEST = 1e6
"""The largest coordinate of a goal [m]."""


def run(words: list[str]) -> int:
    """Send a goal; 0 when the robot has reached it, or is on its way."""
    given, options = parse(parser(), words)
    refuse_time_of_live(options)
    refuse_mixture(options)
    if not options.live_sources:
        raise UsageError(f"name the robot: --source {LIVE_SOURCES}")
    robot = open_moved_by(options)
    assert robot is not None
    # The goal of an action needs a connection; with --no-wait there is none to keep.
    kind = Goal if given.topic or given.no_wait else NavGoal
    topic = given.topic or GOAL_TOPIC
    goal = kind(given.frame, given.x, given.y, given.yaw)
    with closing(robot):
        sender = GoalSender(robot, topic)
        sender.connect(CONNECTED_WITHIN)
        who = sender.send(goal)
        write_lines(f"{goal.words}\nsent to {who}\n")
        return 0 if given.no_wait else _follow(sender, given.listen)


def _follow(sender: GoalSender, seconds: float) -> int:
    """Report the progress of a goal, and return the exit status."""
    if not sender.can_follow:
        topic = text(sender.status_topic, 80)
        write_lines(
            f"what becomes of it is not seen: the robot does not show {topic}, a "
            "hidden topic; start foxglove_bridge with include_hidden:=true\n"
        )
        return 0
    outcome = sender.follow(seconds, lambda said: write_lines(f"{said}\n"))
    if outcome is None:
        write_lines(f"nothing was said of it within {seconds:g} s\n")
        return 1
    if not outcome.is_over:
        write_lines(f"still {outcome.words} after {seconds:g} s\n")
    return 0 if outcome.is_good else 1


def parser() -> Parser:
    """Return the flags of the command."""
    made = Parser(
        prog="sambot-viz goal",
        groups=("source",),
        takes_model=False,
        description="Send a robot on the network to X Y, where it looks towards YAW, "
        "by Nav2's action, or as RViz's 2D Goal Pose does where the robot does not "
        "show that, and say what becomes of it. That the command is "
        "given is the permission. Exit status: 0 reached, or on its way when the time "
        "is over, 1 not sent, refused, cancelled or given up, 2 usage.",
    )
    for name, unit in (("x", "m"), ("y", "m"), ("yaw", "rad")):
        made.add_argument(name, metavar=name.upper(), type=_number, help=f"[{unit}]")
    made.add_argument(
        "-f",
        "--frame",
        default=MAP,
        metavar="FRAME",
        help="the frame of X, Y and YAW (default: %(default)s)",
    )
    made.add_argument(
        "--topic",
        metavar="TOPIC",
        help="send it as 2D Goal Pose does, on this topic; else so only where the "
        f"action is not shown, on {GOAL_TOPIC}",
    )
    made.add_argument(
        "--no-wait",
        action="store_true",
        help="do not wait for what becomes of it; it is sent as 2D Goal Pose does",
    )
    made.add_listen(WAIT, "how long to wait for what becomes of it")
    return made


def _number(word: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = float("nan")
    # False for NaN too.
    if not abs(number) <= FARTHEST:
        raise argparse.ArgumentTypeError(
            f"{word} is not a number from -{FARTHEST:g} to {FARTHEST:g}"
        )
    return number
