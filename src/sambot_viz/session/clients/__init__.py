"""What belongs to one client of a session: its view, its tools, its selection."""
