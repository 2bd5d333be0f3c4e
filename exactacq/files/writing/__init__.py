"""Writers of drawings and results, one a format."""
