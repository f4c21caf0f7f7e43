"""Studio: performers with known truth, filmed by virtual cameras."""
