"""Evaluate: figures against truth, targets and peers."""
