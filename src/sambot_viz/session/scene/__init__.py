"""The scene of a session: displays, frames, background, and rays through them."""
