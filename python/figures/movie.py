#!/usr/bin/python3
"""A film of the side view: movie.py RUN_FOLDER [--out FILE] [--from S] [--to S] [--every S] [--rate N]

FILE ends in .gif, or in .mp4 where ffmpeg is installed; a folder takes numbered images instead. The scales of the colours
are the same in all images. A film has as many images as the run has frames (output.grains.every).
"""
import argparse
import shutil
import sys
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import thalweg
from thalweg import drawing


def chosen_frames(run, start, stop, every):
    """The frames between two times (s), one in every so many seconds."""
    frames, found, due = run.grains.between(start, stop), [], -np.inf
    for k, time in enumerate(frames.times):
        if time >= due - 1e-9:
            found.append(frames[k])
            due = time + every
    if not found:
        raise thalweg.RunFolderError(f"{run.folder}: there is no frame of the grains in this time.")
    return found


def scales(run, frames):
    """Ends of the scales (m/s) of grains and fluid that a dozen of the frames call for."""
    some = frames[::max(1, len(frames) // 12)]
    speeds = np.concatenate([np.linalg.norm(f.velocity, axis=1) for f in some])
    layers = [drawing.fluid_slice(f) for f in (run.fluid.nearest(f.time) for f in some) if f]
    return (drawing.largest_speed_of(speeds, run.diameter),
            max((layer[0].max() for layer in layers if layer), default=None))


def images(run, frames, width):
    """RGB arrays of the figures, all of the same even size."""
    speed, flow = scales(run, frames)
    scale = width / max(run.size[0], run.size[2])   # pixels per metre: the axes take most of the width
    for frame in frames:
        figure = drawing.bed_figure(run, frame, run.fluid.nearest(frame.time), speed, flow, scale)
        figure.set_dpi(width / figure.get_figwidth())
        figure.canvas.draw()
        image = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
        plt.close(figure)
        yield image[:image.shape[0] // 2 * 2, :image.shape[1] // 2 * 2]


def write_gif(images, path, rate):
    from PIL import Image
    first, *rest = [Image.fromarray(image).quantize(128) for image in images]
    first.save(path, save_all=True, append_images=rest, duration=1000.0 / rate, loop=0)


def write_mp4(images, path, rate):
    import subprocess
    images = list(images)
    height, width = images[0].shape[:2]
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
               "-r", str(rate), "-i", "-", "-pix_fmt", "yuv420p", str(path)]
    subprocess.run(command, input=b"".join(image.tobytes() for image in images), check=True)


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
        rendered = images(run, chosen_frames(run, arguments.start, arguments.stop, arguments.every), arguments.width)
        if arguments.out.suffix == ".mp4":
            if not shutil.which("ffmpeg"):
                raise thalweg.RunFolderError(f"{arguments.out}: ffmpeg is not installed; give a .gif or a folder.")
            write_mp4(rendered, arguments.out, arguments.rate)
        elif arguments.out.suffix == ".gif":
            write_gif(rendered, arguments.out, arguments.rate)
        else:
            arguments.out.mkdir(parents=True, exist_ok=True)
            for number, image in enumerate(rendered):
                plt.imsave(arguments.out / f"image_{number:05d}.png", image)
    except thalweg.RunFolderError as error:
        print(f"movie: {error}", file=sys.stderr)
        return 1
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
