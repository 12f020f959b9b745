"""Rules about frames, which one node publishes and others read."""
