"""Blend: poses between poses."""
