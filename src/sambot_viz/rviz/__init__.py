"""The .rviz document: reading, typed properties, lossless writing."""
