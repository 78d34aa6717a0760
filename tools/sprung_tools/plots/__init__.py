"""Pictures of curves: quantities over time, responses over the frequency, modes."""
