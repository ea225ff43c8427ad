"""The VTK XML files of a run (.vtp, .vti, .pvti and .pvd), read without VTK.

Arrays lie in one appended section, raw or in base64, in blocks compressed by zlib or not at all, with headers of 32 or
64 bits: the format of the VTK User's Guide, "VTK XML formats", as Thalweg and VTK's own writers make it.
"""
import base64
import functools
import mmap
import xml.etree.ElementTree as xml
import zlib

import numpy as np

from thalweg.errors import RunFolderError

TYPES = {"Int8": "i1", "UInt8": "u1", "Int32": "i4", "UInt32": "u4", "Int64": "i8", "UInt64": "u8", "Float32": "f4",
         "Float64": "f8"}


def naming_damage(read):
    """A function that reads the file of a path, which says in a sentence when the file ends too soon or is no VTK
    file."""
    @functools.wraps(read)
    def reading(path):
        try:
            return read(path)
        except (xml.ParseError, zlib.error, ValueError, TypeError, AttributeError, LookupError, StopIteration):
            raise RunFolderError(
                f"{path} is damaged or was not written to its end; a restart of the run from before this frame writes it"
                " again."
            ) from None
    return reading


class Appended:
    """The appended section of a file: bytes by offset. data: the file, of which only what is asked for is read; start:
    of the section."""

    def __init__(self, data, start, encoded, header_type, compressed):
        self.data, self.start, self.encoded, self.compressed = data, start, encoded, compressed
        self.word = np.dtype("<" + TYPES[header_type])

    def _piece(self, start, size):
        """`size` bytes that begin at `start`, and where the next piece begins; in base64 every piece has its own
        end."""
        at = self.start + start
        if not self.encoded:
            return self.data[at:at + size], start + size
        length = (size + 2) // 3 * 4
        return base64.b64decode(self.data[at:at + length])[:size], start + length

    def bytes_at(self, offset):
        word = self.word.itemsize
        if not self.compressed:
            size = int(np.frombuffer(self._piece(offset, word)[0], self.word)[0])
            values = self._piece(offset, word + size)[0][word:]
            if len(values) < size:
                raise ValueError("an array ends too soon")
            return values
        blocks, block, last = (int(n) for n in np.frombuffer(self._piece(offset, 3 * word)[0], self.word))
        header, start = self._piece(offset, (3 + blocks) * word)
        sizes = np.frombuffer(header, self.word)[3:].astype(int)
        whole = bytearray(blocks * block - (block - last if last else 0))
        if self.encoded:   # all blocks are one piece
            data, at = self._piece(start, int(sizes.sum()))[0], 0
        else:
            data, at = self.data, self.start + start
        for n, size in enumerate(sizes):
            values = zlib.decompress(data[at:at + size])
            whole[n * block:n * block + len(values)] = values
            at += size
        return whole


def open_file(path):
    """The XML tree of a file and its appended section (None without one)."""
    if not path.exists():
        raise RunFolderError(f"{path}: the frame its index names does not exist.")
    if path.stat().st_size == 0:
        raise RunFolderError(f"{path}: the file is empty.")
    with path.open("rb") as file:
        content = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    mark = content.find(b"<AppendedData")
    if mark < 0:
        return xml.fromstring(content[:]), None
    root = xml.fromstring(content[:mark] + b"</VTKFile>")
    start = content.find(b"_", mark) + 1
    encoded = b'encoding="base64"' in content[mark:start]
    compressor = root.get("compressor")
    if compressor not in (None, "vtkZLibDataCompressor"):
        raise RunFolderError(f"{path}: its arrays are compressed by {compressor}, only vtkZLibDataCompressor is read.")
    return root, Appended(content, start, encoded, root.get("header_type", "UInt32"), compressor is not None)


def arrays_in(section, appended, path):
    """Arrays of a PointData, CellData, Points or Polys section by name."""
    found = {}
    for entry in section if section is not None else ():
        if entry.get("format") != "appended":
            raise RunFolderError(
                f"{path}: its array {entry.get('Name')} is written in the format {entry.get('format')}, "
                "only appended is read."
            )
        values = np.frombuffer(appended.bytes_at(int(entry.get("offset"))), "<" + TYPES[entry.get("type")])
        components = int(entry.get("NumberOfComponents", 1))
        found[entry.get("Name")] = values.reshape(-1, components) if components > 1 else values
    return found


@naming_damage
def read_points(path):
    """Positions (m) of the points in a .vtp file and their arrays by name."""
    root, appended = open_file(path)
    piece = root.find("PolyData/Piece")
    points = next(iter(arrays_in(piece.find("Points"), appended, path).values()), np.zeros((0, 3)))
    return points.astype(float), arrays_in(piece.find("PointData"), appended, path)


@naming_damage
def read_triangles(path):
    """Points (m), triangles as three numbers of points, and arrays of the triangles by name, of a .vtp file."""
    root, appended = open_file(path)
    piece = root.find("PolyData/Piece")
    points = next(iter(arrays_in(piece.find("Points"), appended, path).values()))
    corners = arrays_in(piece.find("Polys"), appended, path)["connectivity"].reshape(-1, 3)
    return points.astype(float), corners, arrays_in(piece.find("CellData"), appended, path)


def numbers(text, kind=float):
    return np.array([kind(word) for word in text.split()])


@naming_damage
def read_image(path):
    """Lower corner (m), spacing (m) and arrays of the cells, as [z, y, x] and a component, of a .vti or .pvti file."""
    root, appended = open_file(path)
    image = root.find("ImageData") if path.suffix == ".vti" else root.find("PImageData")
    spacing = numbers(image.get("Spacing"))
    whole = numbers(image.get("WholeExtent"), int).reshape(3, 2)
    corner = numbers(image.get("Origin")) + whole[:, 0] * spacing
    arrays = {}
    for piece in image.findall("Piece"):
        extent = numbers(piece.get("Extent"), int).reshape(3, 2)
        if path.suffix == ".vti":
            inside = arrays_in(piece.find("CellData"), appended, path)
            shape = (extent[:, 1] - extent[:, 0])[::-1]
            inside = {name: values.reshape(*shape, *values.shape[1:]) for name, values in inside.items()}
        else:
            inside = read_image(path.parent / piece.get("Source"))[2]
        place = tuple(slice(*(extent[axis] - whole[axis, 0])) for axis in (2, 1, 0))
        if np.array_equal(extent, whole):
            return corner, spacing, inside
        for name, values in inside.items():
            shape = (*(whole[:, 1] - whole[:, 0])[::-1], *values.shape[3:])
            arrays.setdefault(name, np.zeros(shape, values.dtype))[place] = values
    return corner, spacing, arrays


def read_index(path):
    """(time in s, path) of every entry of a .pvd index; none if there is no index yet."""
    if not path.exists():
        return []
    content = path.read_bytes()
    try:
        root = xml.fromstring(content)
    except xml.ParseError:   # the run is appending a frame, or has been killed while it did
        try:
            root = xml.fromstring(content[:content.rfind(b"/>") + 2] + b"</Collection></VTKFile>")
        except xml.ParseError:
            raise RunFolderError(f"{path} is damaged; a restart of the run makes it again from the frames.") from None
    return [(float(e.get("timestep")), path.parent / e.get("file")) for e in root.iter("DataSet")]
