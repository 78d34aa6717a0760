#!/usr/bin/python3
"""Starts the command of sprung_tools/cli/make_road.py."""

from sprung_tools.terminal.command import run_command

run_command("make_road")
