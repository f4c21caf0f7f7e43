"""Storage: results in zarr, an index of keys, and nothing else."""
