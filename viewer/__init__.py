"""Viewer: the command line, reports, exports and the window."""
