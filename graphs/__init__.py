"""Graphs: pipelines read, planned and run."""
