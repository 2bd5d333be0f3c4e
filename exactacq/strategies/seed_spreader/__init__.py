"""The Seed Spreader Strategy: a rectangle swept along an M-line."""
