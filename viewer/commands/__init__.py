"""The commands: each file is one, found by its name; a folder is a group of commands."""
