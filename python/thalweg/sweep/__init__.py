"""`thalweg sweep`: one case with many values of its keys, as many runs at a time as there are cores."""
