"""The page of tools/report: the data that it shows of each run (Python), and the page itself (web/)."""
