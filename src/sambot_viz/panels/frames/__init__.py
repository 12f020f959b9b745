"""The Frames panel, and what is known of a frame."""
