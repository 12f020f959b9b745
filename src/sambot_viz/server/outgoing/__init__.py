"""Collect, pack and send what goes out to clients."""
