"""Explain why a text is not XML: the line, the cause and the fix."""
