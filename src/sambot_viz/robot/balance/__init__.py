"""Balance: how a robot stands on the ground, and how easily it tips over."""
