"""What comes from a recording or a robot: topics, its state, player, pictures."""
