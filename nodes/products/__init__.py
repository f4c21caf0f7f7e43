"""The vocabulary: what flows between the stations."""
