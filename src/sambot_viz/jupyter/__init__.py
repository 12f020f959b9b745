"""The page in Jupyter: a tile in the launcher of JupyterLab, and a notebook's cell."""
