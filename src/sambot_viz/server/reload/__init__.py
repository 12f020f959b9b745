"""Read models and configs again when they are saved."""
