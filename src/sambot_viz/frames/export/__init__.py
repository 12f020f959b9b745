"""The frame tree for people and programs: tf2_echo's text, DOT, JSON and SVG."""
