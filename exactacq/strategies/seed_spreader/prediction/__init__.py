"""What the map allows the robot to foresee from a line of its sweep."""
