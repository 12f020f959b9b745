"""The one table of limits for everything that comes from outside.

What is above a limit costs its own topic, file or page; the rest goes on, and a
sentence with the figures says it. docs/limits.md is made from this table.
"""

from sambot_viz.limits.data import *  # noqa: F403
from sambot_viz.limits.drawn import *  # noqa: F403
from sambot_viz.limits.files import *  # noqa: F403
from sambot_viz.limits.meshes import *  # noqa: F403
from sambot_viz.limits.pages import *  # noqa: F403
from sambot_viz.limits.row import LimitRow as LimitRow
