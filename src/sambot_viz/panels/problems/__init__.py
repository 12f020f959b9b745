"""Problems: all of them in one panel, and the status of each display below it."""
