"""Manage the connections of clients: their limits, and backpressure."""
