"""Pictures of the 3D view, drawn by a Chromium or Chrome of this machine."""
