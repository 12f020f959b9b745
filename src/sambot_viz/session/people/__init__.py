"""The people of a session: who may change it, and who only views it."""
