"""Explain why an expansion failed: the line, the cause and the fix."""
