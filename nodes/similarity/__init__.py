"""Similarity: how far apart two frames are."""
