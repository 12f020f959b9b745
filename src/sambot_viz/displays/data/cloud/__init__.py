"""Displays that draw points, and how points get their colours."""
