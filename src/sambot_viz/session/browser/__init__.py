"""What belongs to one browser of a session."""
