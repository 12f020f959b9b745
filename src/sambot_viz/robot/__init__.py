"""From a model file to a `Robot`: no viser, no socket, no thread."""
