#!/usr/bin/env python3
"""A film of the side view: movie.py RUN_FOLDER [--out FILE] [--from S] [--to S] [--every S] [--rate N]

FILE ends in .gif, or in .mp4 where ffmpeg is installed; a folder takes numbered images instead. The scales of the colours
are the same in all images. A film has as many images as the run has frames (output.grains.every).
"""
import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import thalweg_python

import matplotlib
matplotlib.use("Agg")
import numpy as np

import thalweg
from thalweg import film


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=Path, metavar="RUN_FOLDER")
    parser.add_argument("--out", type=Path, default=Path("movie.gif"))
    parser.add_argument("--from", dest="start", type=float, default=-np.inf)
    parser.add_argument("--to", dest="stop", type=float, default=np.inf)
    parser.add_argument("--every", type=float, default=0.0, help="s between frames (default: all)")
    parser.add_argument("--rate", type=float, default=20.0, help="images a second")
    parser.add_argument("--width", type=int, default=900, help="pixels")
    arguments = parser.parse_args()
    try:
        run = thalweg.Run(arguments.run)
        frames = film.chosen_frames(run, arguments.start, arguments.stop, arguments.every)
        film.write_film(run, frames, arguments.out, arguments.rate, arguments.width)
    except thalweg.RunFolderError as error:
        print(f"movie: {error}", file=sys.stderr)
        return 1
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
