"""Slips: words close to the intended ones, and their consequences."""
