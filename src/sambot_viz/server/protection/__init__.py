"""Decide who may connect, what clients may send, and how much of it."""
