"""The property types of RViz: declared once, then read, checked and written."""
