"""Studies: many runs of one run file with other parameters, kept as they end, and what they show."""
