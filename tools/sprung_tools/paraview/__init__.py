"""Modes and runs as files that ParaView reads."""
