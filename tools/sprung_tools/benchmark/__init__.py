"""What evaluations and whole runs cost."""
