"""The page that tools/report makes: what it shows of each run (Python), and the page itself (HTML, CSS, JavaScript)."""
