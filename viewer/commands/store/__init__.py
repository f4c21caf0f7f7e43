"""Look after a store."""
