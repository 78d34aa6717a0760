"""Measurement of the cost of evaluations and whole runs."""
