"""Points, curves, where they meet, and places on a curve in order."""
