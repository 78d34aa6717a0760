"""Sampled signals: spectra, the weighting of vibration by people, random roads."""
