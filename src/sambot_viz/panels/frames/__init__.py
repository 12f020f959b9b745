"""The Frames panel, and the facts about a frame."""
