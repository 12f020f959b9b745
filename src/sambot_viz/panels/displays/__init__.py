"""The Displays panel."""
