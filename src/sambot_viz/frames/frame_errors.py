"""The two ways a frame can be refused: when it is asked for, and when it is set.

Both have the texts of tf2 and RViz as attributes, because displays, `echo` and the
Frames panel show exactly those; the message of the exception itself explains more and
names the frames that exist.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from sambot_viz.errors import FrameError, did_you_mean

LookupReason = Literal[
    "unknown-frame",
    "empty-name",
    "not-connected",
    "ring",
    "extrapolation-past",
    "extrapolation-future",
    "extrapolation-one",
]
TransformFault = Literal[
    "TF_SELF_TRANSFORM",
    "TF_NO_FRAME_ID",
    "TF_NO_CHILD_FRAME_ID",
    "TF_NAN_INPUT",
    "TF_DENORMALIZED_QUATERNION",
    "TF_OLD_DATA",
]


class TransformRefused(FrameError):
    """A transform that every tf2 listener would ignore.

    Attributes:
        tf2_name: tf2's name for the fault, such as "TF_NAN_INPUT".
    """

    def __init__(self, tf2_name: TransformFault, message: str) -> None:
        self.tf2_name: TransformFault = tf2_name
        super().__init__(f"{tf2_name}: {message}")


class FrameCycleError(FrameError):
    """A parent that is below its own child.

    tf2 takes such a transform and fails at every later look-up.

    Attributes:
        ring: the frames of the ring, first and last the same, each the parent of
            the next.
        tf2_text: tf2's error of the look-ups.
    """

    tf2_text = "The tf tree is invalid because it contains a loop."

    def __init__(self, ring: tuple[str, ...]) -> None:
        self.ring = ring
        super().__init__(
            f"'{ring[0]}' cannot be the parent of '{ring[1]}', because it is "
            f"already below it and the frames would form a ring: {' → '.join(ring)}; "
            "turn the transform round or remove the other one"
        )


class LookupRefused(FrameError):
    """A look-up that has no answer.

    Attributes:
        target: the frame in which the pose was wanted (RViz's fixed frame).
        source: the frame whose pose was wanted.
        reason: "unknown-frame", "empty-name", "not-connected", "ring", or
            "extrapolation-…" for a time before the first ("past") or after the last
            sample ("future") on the way, or beside the only one ("one").
        unknown: the frame that does not exist, or "".
        times: the time that was asked for and that of the nearest sample [ns], for an
            extrapolation; else None.
        tf2_text: the text of tf2 (what tf2_echo shows while it waits).
        rviz_text: the longer text of RViz's displays.
    """

    def __init__(
        self,
        target: str,
        source: str,
        reason: LookupReason,
        known: Iterable[str] = (),
        unknown: str = "",
        times: tuple[int, int] | None = None,
    ) -> None:
        self.target = target
        self.source = source
        self.reason: LookupReason = reason
        self.unknown = unknown
        self.times = times
        if times is not None:
            self.tf2_text = _extrapolation(target, source, reason, times)
            message = _no_data(target, source, reason, times)
        else:
            self.tf2_text = _tf2_text(target, source, reason, unknown)
            message = _message(target, source, reason, known, unknown)
        self.rviz_text = _rviz_text(target, source, self.tf2_text, reason, unknown)
        super().__init__(message)


def _message(
    target: str, source: str, reason: LookupReason, known: Iterable[str], unknown: str
) -> str:
    if reason == "unknown-frame":
        return f"no frame '{unknown}'; {did_you_mean(unknown, known)}"
    if reason == "empty-name":
        return "a frame name is empty; name a target and a source frame"
    if reason == "ring":
        return (
            f"no way from '{source}' to '{target}': the frames above '{unknown}' form "
            "a ring; two publishers disagree about which is the parent"
        )
    return (
        f"no way from '{source}' to '{target}': they belong to separate trees; "
        "a transform between the two trees is missing"
    )


def _tf2_text(target: str, source: str, reason: LookupReason, unknown: str) -> str:
    if reason == "ring":
        return FrameCycleError.tf2_text
    if reason == "not-connected":
        # The missing blank after the first full stop is tf2's.
        return (
            f"Could not find a connection between '{target}' and '{source}' because "
            "they are not part of the same tree."
            "Tf has two or more unconnected trees."
        )
    argument = "target_frame" if unknown == target else "source_frame"
    if reason == "empty-name":
        fault = "in tf2 frame_ids cannot be empty"
    else:
        fault = "frame does not exist"
    return (
        f'Invalid frame ID "{unknown}" passed to canTransform argument {argument}'
        f" - {fault}"
    )


def _rviz_text(
    target: str, source: str, tf2_text: str, reason: LookupReason, unknown: str
) -> str:
    if reason not in ("unknown-frame", "empty-name"):
        return f"No transform to fixed frame [{target}]. TF error: [{tf2_text}]"
    role = "Fixed Frame" if unknown == target else "Frame"
    return f"For frame [{source}]: {role} [{unknown}] does not exist"


def _extrapolation(
    target: str, source: str, reason: LookupReason, times: tuple[int, int]
) -> str:
    asked, data = (f"{time / 1e9:.6f}" for time in times)
    if reason == "extrapolation-one":
        fault = f"at time {asked}, but only time {data} is in the buffer"
    elif reason == "extrapolation-past":
        fault = f"into the past.  Requested time {asked} but the earliest data is at "
        fault += f"time {data}"
    else:
        fault = f"into the future.  Requested time {asked} but the latest data is at "
        fault += f"time {data}"
    return (
        f"Lookup would require extrapolation {fault}, when looking up transform from "
        f"frame [{source}] to frame [{target}]"
    )


def _no_data(
    target: str, source: str, reason: LookupReason, times: tuple[int, int]
) -> str:
    apart = abs(times[1] - times[0]) / 1e9
    word = {
        "extrapolation-past": f"the earliest data is {apart:.3g} s newer",
        "extrapolation-future": f"the latest data is {apart:.3g} s older",
    }.get(reason, f"there is only one value, {apart:.3g} s away")
    return (
        f"no transform from '{source}' to '{target}' at {times[0] / 1e9:.6f} s: {word}"
    )
