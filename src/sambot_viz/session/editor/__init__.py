"""The text of the model in a session: what its users write, and what is on the disk."""
