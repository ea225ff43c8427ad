"""A film of the side view: figures of the frames of a run as a .gif, an .mp4 or a folder of numbered images."""
import contextlib
import itertools
import re
import shutil
import subprocess
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from thalweg import drawing
from thalweg.errors import RunFolderError


FASTEST_GIF = 50                    # images a second
NARROWEST, WIDEST = 100, 10000      # pixels


def chosen_frames(run, start=-np.inf, stop=np.inf, every=0.0):
    """The frames between two times (s), at least `every` seconds apart: of the grains, or of the fluid where there are
    none."""
    drawing.refuse_column(run)
    shown, kind = (run.grains, "grains") if len(run.grains) else (run.fluid, "fluid")
    frames, found, due = shown.between(start, stop), [], -np.inf
    for k, time in enumerate(frames.times):
        if time >= due - 1e-9:
            found.append(k)
            due = time + every
    if not found:
        where = "in this time" if len(shown) else f"(output.{kind}.every in the case)"
        raise RunFolderError(f"{run.folder}: there is no frame of the {kind} {where}.")
    return frames.chosen(found)


def fluid_behind(run, frame):
    """The frame of the fluid that belongs to a chosen one; None where none is stored."""
    return run.fluid.nearest(frame.time) if len(run.grains) else frame


def scales(run, frames):
    """Ends of the scales (m/s) of grains and fluid that a dozen of the frames call for; None for what is not there."""
    some = frames[::max(1, len(frames) // 12)]
    layers = (drawing.fluid_slice(fluid) for fluid in (fluid_behind(run, frame) for frame in some) if fluid)
    flow = max((layer[0].max() for layer in layers if layer), default=None)
    if not len(run.grains):
        return None, flow
    speeds = np.concatenate([np.linalg.norm(frame.velocity, axis=1) for frame in some])
    return drawing.largest_speed_of(speeds, drawing.typical_diameter(run, frames[0])), flow


def images(run, frames, width):
    """RGB arrays of the figures, all of the same even size; width in pixels."""
    speed, flow = scales(run, frames)
    scale = width / max(run.size[0], run.size[2])   # pixels per metre: the axes take most of the width
    for frame in frames:
        fluid = fluid_behind(run, frame)
        if len(run.grains):
            figure = drawing.bed_figure(run, frame, fluid, speed, flow, scale)
        else:
            figure = drawing.flow_figure(run, fluid, flow)
        figure.set_dpi(width / figure.get_figwidth())
        figure.canvas.draw()
        image = np.asarray(figure.canvas.buffer_rgba())[..., :3].copy()
        plt.close(figure)
        yield image[:image.shape[0] // 2 * 2, :image.shape[1] // 2 * 2]


def write_gif(pictures, path, rate, count):
    """count: of the pictures. A .gif has whole hundredths of a second for each: they vary, so that the film is as long
    as it should be."""
    from PIL import Image
    durations = np.diff(np.round(np.arange(count + 1) * 100.0 / rate).astype(int)) * 10   # ms
    quantized = (Image.fromarray(picture).quantize(128) for picture in pictures)
    next(quantized).save(path, save_all=True, append_images=quantized, duration=durations.tolist(), loop=0)


def write_mp4(pictures, path, rate):
    first = next(pictures)
    height, width = first.shape[:2]
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}",
               "-r", str(rate), "-i", "-", "-pix_fmt", "yuv420p", str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE) as ffmpeg, contextlib.suppress(BrokenPipeError):
        # A broken pipe: ffmpeg has ended, and its exit code says so.
        for picture in itertools.chain([first], pictures):
            ffmpeg.stdin.write(picture.tobytes())
        ffmpeg.stdin.close()
    if ffmpeg.returncode:
        raise RunFolderError(f"{path}: ffmpeg ended with exit code {ffmpeg.returncode}.")


def write_images(pictures, folder):
    """Numbered from 0 on; those that a longer film has left in the folder go."""
    written = set()
    for number, picture in enumerate(pictures):
        path = folder / f"image_{number:05d}.png"
        plt.imsave(path, picture)
        written.add(path)
    for path in set(folder.iterdir()) - written:
        if re.fullmatch(r"image_\d{5,}\.png", path.name):
            path.unlink()


def write_film(run, frames, path, rate=20.0, width=900):
    """A film of the frames, `rate` of them a second, `width` pixels wide: an .mp4, which takes ffmpeg, a .gif, or else
    a folder of images."""
    path = Path(path)
    if not 0.0 < rate < np.inf:
        raise RunFolderError(f"--rate {rate:g}: give a number of images a second above 0.")
    if path.suffix == ".gif" and rate > FASTEST_GIF:
        raise RunFolderError(f"--rate {rate:g}: viewers show at most {FASTEST_GIF} images of a .gif a second; give an .mp4.")
    if not NARROWEST <= width <= WIDEST:
        raise RunFolderError(f"--width {width}: give {NARROWEST} to {WIDEST} pixels.")
    if path.suffix == ".mp4" and not shutil.which("ffmpeg"):
        raise RunFolderError(f"{path}: ffmpeg is not installed; give a .gif or a folder.")
    (path.parent if path.suffix else path).mkdir(parents=True, exist_ok=True)
    pictures = images(run, frames, width)
    if path.suffix == ".mp4":
        write_mp4(pictures, path, rate)
    elif path.suffix == ".gif":
        write_gif(pictures, path, rate, len(frames))
    elif path.suffix:
        raise RunFolderError(f"{path}: give a .gif, an .mp4 or a folder.")
    else:
        write_images(pictures, path)
