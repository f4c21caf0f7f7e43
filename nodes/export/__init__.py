"""Export: products as files that other programs read."""
