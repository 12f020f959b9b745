"""The 3D view as a picture or a page: pictures need a Chromium of this machine."""
