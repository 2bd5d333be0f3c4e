"""What a path sees: the visibility complex, the sensor, the map and its history."""
