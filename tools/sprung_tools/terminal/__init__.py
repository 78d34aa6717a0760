"""What a command prints: its help, tables, progress, and the line that says why it ended."""
