"""The display of depth images as points."""
