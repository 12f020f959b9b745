"""Displays that draw the messages of topics."""
