"""The differential drive: exact arcs, and the two driven wheels of a robot."""
