"""The commands, one module each: arguments in, text and files out."""
