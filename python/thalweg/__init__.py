"""The run folders of Thalweg as numpy arrays in SI units.

    import thalweg
    run = thalweg.Run("run/flume")
    run.series["q_star"], run.series.units["q_s"]      # columns of series.csv
    for frame in run.grains: frame.time, frame.position, frame.velocity
    thalweg.mean_with_error(run.series["q_star"])

A run that is still going can be read like a finished one.
"""
from thalweg.errors import RunFolderError
from thalweg.means import mean_with_error, steadiness
from thalweg.run import Run

__all__ = ["Run", "RunFolderError", "mean_with_error", "steadiness"]
