"""Recordings and live robots in a session: what their messages move, and when."""
