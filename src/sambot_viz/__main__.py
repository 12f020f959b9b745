"""``python -m sambot_viz`` is the command ``sambot-viz``."""

import sys

from sambot_viz.cli import main

sys.exit(main())
