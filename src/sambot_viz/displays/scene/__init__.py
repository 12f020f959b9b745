"""Building blocks of displays: lines, solids, frame nodes, files of shapes."""
