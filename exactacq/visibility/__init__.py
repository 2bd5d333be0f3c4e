"""What one place sees within a range, free segments, and links between obstacles."""
