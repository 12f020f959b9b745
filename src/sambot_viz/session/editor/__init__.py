"""The model's text in a session: users' changes and the files on disk."""
