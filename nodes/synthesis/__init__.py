"""Synthesis: new motion from captured motion."""
