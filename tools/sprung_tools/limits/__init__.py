"""The speeds at which the driver of a vehicle has enough: over rough terrain, and over single obstacles."""
