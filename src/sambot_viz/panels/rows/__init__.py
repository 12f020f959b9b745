"""Rows: what panels send to the page, kept, numbered and compared."""
