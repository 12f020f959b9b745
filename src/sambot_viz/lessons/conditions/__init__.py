"""What must hold at the end of a step: one class for each kind of condition."""
