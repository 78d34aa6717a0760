"""What happened in one or more runs: their names, captions, measures of ride, the history of their modes."""
