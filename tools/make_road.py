#!/usr/bin/python3
"""Starts the command of sprung_tools/cli/make_road.py."""

from sprung_tools.cli import make_road
from sprung_tools.terminal.program import run_tool

run_tool(make_road.main)
