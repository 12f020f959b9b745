"""The way out to a robot: messages, their encoding, and their outcome."""
