"""What is visible from a place within a range, free segments, and shortest links between obstacles."""
