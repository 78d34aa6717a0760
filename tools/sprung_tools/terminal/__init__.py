"""Output of a command: help, tables, progress, and the last line with the reason of an error."""
