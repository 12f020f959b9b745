"""Slips: words that are near what was meant, and what follows from them."""
