"""Evaluation of runs: their names and captions, measures of the ride, the history of their modes."""
