"""Rules that explain what is wrong with a model and how to mend it."""
