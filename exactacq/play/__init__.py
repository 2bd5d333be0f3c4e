"""A page to draw scenes in and to watch the robot explore them, served on this machine alone."""
