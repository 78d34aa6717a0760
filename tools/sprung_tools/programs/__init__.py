"""Finding and starting the two programs."""
