"""Pure mathematics used by several stations."""
