"""`thalweg report`: one page that describes a run."""
