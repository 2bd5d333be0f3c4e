"""A finished run checked again by other means than those that made it."""
