"""Collect, pack and send messages to clients."""
