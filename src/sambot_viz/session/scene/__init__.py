"""What a session draws: displays, frames, background, and rays through them."""
