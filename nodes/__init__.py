"""Nodes: the typed algorithms, one folder per station, and the words they share."""
