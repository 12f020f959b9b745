"""The way out to a robot: what is sent, how it is written, and what became of it."""
