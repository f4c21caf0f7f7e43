"""Align: one topology over all frames of all takes."""
