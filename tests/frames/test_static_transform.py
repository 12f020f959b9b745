"""The arguments of static_transform_publisher."""

from __future__ import annotations

import math

import pytest

from sambot_viz.errors import UsageError
from sambot_viz.frames.static_transform import (
    StaticTransformError,
    parse_static_transform,
)

FORM = 'give "X Y Z YAW PITCH ROLL PARENT CHILD" (metres, radians, yaw before pitch'
"""How every explanation of the form begins."""


def test_the_tutorials_first_transform() -> None:
    static = parse_static_transform("0.1 0 0.2 0 0 0 base_link base_laser")
    assert (static.parent, static.child) == ("base_link", "base_laser")
    assert static.transform.translation.tolist() == [0.1, 0.0, 0.2]
    assert static.warnings == ()


def test_eight_values_have_yaw_before_pitch_and_roll() -> None:
    static = parse_static_transform("0 0 0 0.3 0.2 0.1 a b")
    assert static.transform.rpy == pytest.approx((0.1, 0.2, 0.3))


def test_nine_values_are_the_quaternion_form() -> None:
    static = parse_static_transform("1 2 3 0 0 1 0 a b")
    assert static.transform.rotation_xyzw.tolist() == [0, 0, 1, 0]
    assert static.transform.rpy == pytest.approx((0, 0, math.pi))


def test_flags_have_defaults_and_take_negative_values() -> None:
    static = parse_static_transform("--yaw 1 --x -2 --child-frame-id b --frame-id a")
    assert static.transform.translation.tolist() == [-2, 0, 0]
    assert static.transform.rpy == pytest.approx((0, 0, 1))
    turned = parse_static_transform("--qx 1 --qw 0 --frame-id a --child-frame-id b")
    assert turned.transform.rotation_xyzw.tolist() == [1, 0, 0, 0]


def test_a_list_of_words_is_taken_as_it_is() -> None:
    words = ["0", "0", "1", "0", "0", "0", "a frame", "b"]
    assert parse_static_transform(words).parent == "a frame"
    text = "0 0 1 0 0 0 'a frame' b"
    assert parse_static_transform(text) == parse_static_transform(words)


@pytest.mark.parametrize(
    ("arguments", "ros_text", "hint"),
    [
        ("", "Frame id must not be empty", f"name it with --frame-id, or {FORM}"),
        ("--frame-id a", "Child frame id must not be empty", "name it with --child"),
        ("0 0 0 0 0 0 / b", "Frame id must not be empty", "name it with --frame-id"),
        (
            "0 0 0",
            "Extra unparsed arguments on command-line",
            f"3 values are neither 8 nor 9; {FORM}",
        ),
        (
            "--yaw=1 --frame-id a --child-frame-id b",
            "Extra unparsed arguments on command-line",
            "write '--yaw 1': the value is a word of its own",
        ),
        (
            "--jaw 1 --frame-id a --child-frame-id b",
            "Extra unparsed arguments on command-line",
            "there is no flag '--jaw'; the flags are --x, --y, --z, --yaw, ",
        ),
        (
            "1 --frame-id a --child-frame-id b",
            "Extra unparsed arguments on command-line",
            "the words 1 belong to no flag",
        ),
        (
            "0 0 0 0 0 0 a b 100",
            "Failed to parse qw argument as float",
            "nine values are X Y Z QX QY QZ QW PARENT CHILD; the last one looks like "
            "the period in milliseconds of ROS 1, which ROS 2 does not have: leave "
            "'100' out",
        ),
        (
            "0 0 0 0 0 0 a b --x 1",
            "Cannot specify both new-style (flags) and old-style (arguments)",
            f"leave the flags out and {FORM}",
        ),
        (
            "--qx 1 --yaw 1 --frame-id a --child-frame-id b",
            "Cannot specify both quaternion and Euler rotations",
            "give either --qx --qy --qz --qw or --roll --pitch --yaw",
        ),
        ("--x", "Not enough arguments for --x", "its value is the next word"),
        ("--x a", "Failed to parse --x argument as float", "'a' is not a number"),
        (
            "0 0 up 0 0 0 a b",
            "Failed to parse z argument as float",
            f"'up' is not a number; {FORM}",
        ),
        (
            "1e999 0 0 0 0 0 a b",
            "Failed to parse x argument as float",
            "'1e999' is too large",
        ),
        (
            "0 0 0 0 0 0 /a a",
            "cannot publish static transform from 'a' to 'a', exiting",
            "a frame cannot be its own parent",
        ),
        (
            "--qz 1 --frame-id a --child-frame-id b",
            "TF_DENORMALIZED_QUATERNION: the quaternion (0, 0, 1, 1) has the length "
            "1.414, and a rotation needs length 1",
            "the real tool publishes it, and every listener ignores it",
        ),
        (
            "0 nan 0 0 0 0 a b",
            "TF_NAN_INPUT: xyz is (0, nan, 0)",
            "the real tool publishes it, and every listener ignores it",
        ),
        ("0 0 0 'a", 'cannot split "0 0 0 \'a" into words', "No closing quotation; "),
    ],
)
def test_an_error_has_the_real_tools_text_and_an_explanation(
    arguments: str, ros_text: str, hint: str
) -> None:
    with pytest.raises(StaticTransformError) as caught:
        parse_static_transform(arguments)
    assert caught.value.ros_text == ros_text
    assert caught.value.hint.startswith(hint)
    assert str(caught.value) == f"{ros_text}; {caught.value.hint}"
    assert isinstance(caught.value, UsageError)


def test_what_the_real_tool_takes_in_silence_is_a_warning() -> None:
    static = parse_static_transform("1.5m 0 0 0 0 0 /a b --yaw 2")
    assert static.transform.translation[0] == 1.5
    assert static.transform.rpy[2] == 0
    assert static.warnings == (
        "--yaw 2 has no effect beside the 8 bare values",
        "tf2 strips the leading slash of '/a'",
        "'1.5m' is read as 1.5: leave 'm' out",
    )


def test_an_angle_of_more_than_a_turn_is_probably_in_degrees() -> None:
    parsed = parse_static_transform("0 0 0 90 0 -45 a b")
    assert parsed.warnings == (
        "roll -45 looks like degrees, but it is in radians: write -0.7854",
        "yaw 90 looks like degrees, but it is in radians: write 1.5708",
    )
    assert parse_static_transform("0 0 0 6.2832 0 -3.14 a b").warnings == ()
