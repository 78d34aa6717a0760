"""What was run, from the texts and the numbers that a results file keeps of its model."""
