"""TF: axes, names and arrows of the frames."""
