"""What a command says on a terminal: its help and exit code, tables, progress."""
