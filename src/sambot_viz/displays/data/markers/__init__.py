"""The displays Marker and MarkerArray."""
