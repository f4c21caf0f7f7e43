"""Motion graphs: where one take can flow into another."""
