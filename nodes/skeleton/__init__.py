"""Skeletons: joints of labelled surfaces, and motion capture from files."""
