"""Rules about the model itself: its shapes, masses, wheels and sensors."""
