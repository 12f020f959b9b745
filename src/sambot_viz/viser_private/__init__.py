"""Every use of a private name of viser, each with its reason and a test.

viser is pinned to a minor version (pyproject.toml); tests/test_viser_private.py fails
when one of these names has moved.
"""

from sambot_viz.viser_private.connections import (
    allow_late_messages,
    connection_of,
    larger_messages,
    on_connection,
    quiet_websockets,
    without_banner,
)
from sambot_viz.viser_private.followed_scene import FollowedScene
from sambot_viz.viser_private.moving_poses import MovingPoses, set_pose, set_poses
from sambot_viz.viser_private.outgoing import (
    Message,
    MessageBuffer,
    Packer,
    WindowLoop,
    broadcast_buffer,
    more_follows,
    own_buffer,
    replace_flush,
    replace_window_loop,
)
from sambot_viz.viser_private.scene_nodes import (
    compare_poses_quickly,
    fill_background,
    is_removed,
    node_count,
    remember_prop_types,
    scene_bytes,
    send_file,
    share_arrays,
    tell_poses_of_remade_nodes,
)
from sambot_viz.viser_private.scene_recorder import Recorder
from sambot_viz.viser_private.widgets import (
    awaits_picture,
    drawn_by,
    input_handle,
    is_for_all,
    send_value,
)

__all__ = [
    "FollowedScene",
    "Message",
    "MessageBuffer",
    "MovingPoses",
    "Packer",
    "Recorder",
    "WindowLoop",
    "allow_late_messages",
    "awaits_picture",
    "broadcast_buffer",
    "compare_poses_quickly",
    "connection_of",
    "drawn_by",
    "fill_background",
    "input_handle",
    "is_for_all",
    "is_removed",
    "larger_messages",
    "more_follows",
    "node_count",
    "on_connection",
    "own_buffer",
    "quiet_websockets",
    "remember_prop_types",
    "replace_flush",
    "replace_window_loop",
    "scene_bytes",
    "send_file",
    "send_value",
    "set_pose",
    "set_poses",
    "share_arrays",
    "tell_poses_of_remade_nodes",
    "without_banner",
]
