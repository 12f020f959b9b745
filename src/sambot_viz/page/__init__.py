"""The script that makes viser's page look like RViz, and its delivery."""
