"""The figures of `thalweg plot`: each module draws one kind; thalweg.plot has their options."""
import matplotlib

matplotlib.use("Agg")   # no screen is needed
