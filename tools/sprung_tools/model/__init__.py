"""The model that was run, from the values in a results file."""
