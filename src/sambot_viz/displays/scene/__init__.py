"""What displays draw with: lines, solids, frame nodes, and the files behind shapes."""
