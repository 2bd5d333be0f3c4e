"""What the map lets one see from a line: the look ahead."""
