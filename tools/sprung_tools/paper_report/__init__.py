"""The report dynamics/models/truck/README.md: its runs, claims, tables and figures. tools/paper_figures makes it."""
