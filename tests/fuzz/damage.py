"""Ways in which files are damaged: bytes of any file, lines of a text, and the structure of an HDF5 file.

Each way takes the bytes of a whole file and a random.Random, and returns other bytes.
"""
import io

import h5py
import numpy


# ---- any file
# ------------------------------------------------------------------------------------------------------------

def cut(data, chance):
    return data[:chance.randrange(len(data))]


def cut_a_little(data, chance):
    return data[:-chance.randint(1, min(16, len(data)))]


def flip(data, chance, first=0, last=None):
    """A bit of a byte."""
    text = bytearray(data)
    text[chance.randrange(first, min(last or len(text), len(text)))] ^= 1 << chance.randrange(8)
    return bytes(text)


def flip_in_head(data, chance):
    return flip(data, chance, 0, 512)


def noise(data, chance):
    """Sixteen bytes of noise."""
    at = chance.randrange(len(data))
    return data[:at] + chance.randbytes(16) + data[at + 16:]


def zeros(data, chance):
    """A block of zeros, as a crash of the machine leaves it."""
    at = chance.randrange(len(data)) // 512 * 512
    return data[:at] + bytes(len(data[at:at + 512])) + data[at + 512:]


def nothing(data, chance):
    return b""


def appended(data, chance):
    return data + chance.randbytes(chance.randint(1, 64))


def other_file(data, chance):
    return chance.choice(
        [
            b"\x89PNG\r\n\x1a\n" + chance.randbytes(200), b"\x7fELF" + bytes(300), b"PK\x03\x04" + chance.randbytes(99),
            b"<html><body>404</body></html>\n", chance.randbytes(1000),
        ]
    )


ANY = [cut, cut, cut_a_little, flip, flip, flip, flip_in_head, noise, zeros, nothing, appended, other_file]


# ---- text
# ----------------------------------------------------------------------------------------------------------------

def inserted(name, *patterns):
    def way(data, chance):
        at = chance.randrange(len(data) + 1)
        return data[:at] + chance.choice(patterns) + data[at:]
    way.__name__ = name
    return way


def line_of(name, change):
    def way(data, chance):
        lines = data.splitlines(keepends=True)
        at = chance.randrange(len(lines))
        return b"".join(lines[:at] + change(lines[at]) + lines[at + 1:])
    way.__name__ = name
    return way


odd_byte = inserted(
    "odd_byte", b"\0", b"\x04", b"\x1a", b"\x7f", b"\xff", b"\xc3", b"\xed\xa0\x80", b"\xf5\x80\x80\x80", b"\x1b[2J"
)
tab = inserted("tab", b"\t", b"\t\t")
carriage_return = inserted("carriage_return", b"\r")
bracket = inserted(
    "bracket", b"[", b"]", b"{", b"}", b"\"", b"'", b"&", b"*", b"!", b"|", b">", b"%", b"@", b"`", b": ", b"- ", b"#"
)
byte_order_mark = inserted("byte_order_mark", b"\xef\xbb\xbf")
line_lost = line_of("line_lost", lambda line: [])
line_twice = line_of("line_twice", lambda line: [line, line])
tabs_for_spaces = line_of("tabs_for_spaces", lambda line: [line.replace(b"  ", b"\t")])
indented = line_of("indented", lambda line: [b" " + line])

TEXT = [
    odd_byte, odd_byte, tab, carriage_return, bracket, bracket, byte_order_mark, line_lost, line_twice, tabs_for_spaces,
    indented,
]


def utf_16(data, chance):
    return data.decode().encode(chance.choice(["utf-16", "utf-16-le", "utf-16-be", "utf-32"]))


def deep(opening, closing):
    def way(data, chance):
        levels = chance.choice([33, 1000, 100000])
        return data + b"\nname: " + opening * levels + closing * levels + b"\n"
    way.__name__ = f"deep {opening!r}"
    return way


def deep_indentation(data, chance):
    return data + b"\nname:\n" + b"".join(b" " * n + b"a:\n" for n in range(1, chance.choice([40, 2000])))


def laughs(data, chance):
    levels = chance.randint(5, 9)
    text = b"\na0: &a0 [" + b", ".join([b"lol"] * 10) + b"]\n"
    for n in range(1, levels):
        text += b"a%d: &a%d [%s]\n" % (n, n, b", ".join([b"*a%d" % (n - 1)] * 10))
    return data + text


def contains_itself(data, chance):
    return data + b"\nname: &me [*me]\n"


def second_document(data, chance):
    return data + b"\n---\n" + chance.choice([data, b"run: {until: 99}\n", b"- 1\n"])


def many_keys(data, chance):
    return data + b"\n" + b"".join(b"key_%d: 1\n" % n for n in range(100000))


def long_word(data, chance):
    return data + b"\nname: " + b"x" * 3000000 + b"\n"


YAML = TEXT + [
    utf_16, deep(b"[", b"]"), deep(b"{a: ", b"}"), deep(b"- ", b""), deep_indentation, laughs, contains_itself,
    second_document, many_keys, long_word,
]


# ---- HDF5
# ----------------------------------------------------------------------------------------------------------------

def in_hdf5(change):
    """change(file, name of a dataset, chance); its name and attributes but the checksum are kept where it makes a new
    one."""
    def way(data, chance):
        memory = io.BytesIO(data)
        with h5py.File(memory, "r+") as file:
            change(file, chance.choice(datasets_of(file)), chance)
        return memory.getvalue()
    way.__name__ = change.__name__
    return way


def datasets_of(file):
    names = []
    file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) and item.size else None)
    return sorted(names)


def replaced(file, name, **made):
    del file[name]
    return file.create_dataset(name, **made)


@in_hdf5
def scalar(file, name, chance):
    replaced(file, name, data=1.0)


@in_hdf5
def missing(file, name, chance):
    del file[name]


@in_hdf5
def group(file, name, chance):
    del file[name]
    file.create_group(name)


@in_hdf5
def no_rows(file, name, chance):
    replaced(file, name, shape=(0,) + file[name].shape[1:], dtype=file[name].dtype)


@in_hdf5
def one_row_more(file, name, chance):
    values = file[name][()]
    replaced(file, name, data=numpy.concatenate([values, values[-1:]]))


@in_hdf5
def other_rank(file, name, chance):
    values = file[name][()]
    replaced(
        file, name,
        data=values.reshape(values.shape + (1,))
        if chance.random() < 0.5
        else values.ravel()[:1].reshape(1, 1, 1, 1, 1),
    )


@in_hdf5
def other_type(file, name, chance):
    values = file[name][()]
    kind = chance.choice(["f4", "i4", ">f8", "u8", "S8", "complex128"])
    replaced(file, name, data=values.astype(kind))


@in_hdf5
def huge(file, name, chance):
    """Rows that the file only announces."""
    values = file[name]
    rows = chance.choice([1 << 31, 1 << 40, 1 << 60])
    shape, kind = (rows,) + values.shape[1:], values.dtype
    replaced(
        file, name, shape=shape, dtype=kind, chunks=(1024,) + values.shape[1:], maxshape=(None,) + values.shape[1:]
    )


@in_hdf5
def huge_everywhere(file, name, chance):
    """All data of a group announce the same rows."""
    for other in datasets_of(file):
        if other.split("/")[0] == name.split("/")[0]:
            values = file[other]
            replaced(
                file, other, shape=(1 << 40,) + values.shape[1:], dtype=values.dtype, chunks=(64,) + values.shape[1:]
            )


@in_hdf5
def not_written(file, name, chance):
    replaced(file, name, shape=file[name].shape, dtype=file[name].dtype)


@in_hdf5
def odd_value(file, name, chance):
    """Written as HDF5 does, so that nothing but our own checksum tells."""
    values = file[name][()]
    at = tuple(chance.randrange(length) for length in values.shape)
    whole = values.dtype.kind == "i"
    values[at] = chance.choice([-1, 2**62, 2**31] if whole else [numpy.nan, numpy.inf, -1e30, -values[at] - 1.0])
    file[name][...] = values


@in_hdf5
def odd_value_anew(file, name, chance):
    """In data without a checksum, as another program writes them."""
    values = file[name][()]
    at = tuple(chance.randrange(length) for length in values.shape)
    values[at] = chance.choice([-7, 2**62] if values.dtype.kind == "i" else [numpy.nan, numpy.inf, -1e30])
    replaced(file, name, data=values)


@in_hdf5
def link_in_a_circle(file, name, chance):
    del file[name]
    file[name] = h5py.SoftLink("/" + name)


@in_hdf5
def attribute_lost(file, name, chance):
    holder = chance.choice([file[name], file[name].parent])
    for attribute in list(holder.attrs):
        del holder.attrs[attribute]


@in_hdf5
def attribute_of_another_type(file, name, chance):
    holder = file[name].parent
    for attribute in list(holder.attrs):
        holder.attrs[attribute] = chance.choice(["text of any length", 7, [1, 2, 3]])


HDF5 = [
    scalar, missing, group, no_rows, one_row_more, other_rank, other_type, huge, huge_everywhere, not_written,
    odd_value, odd_value, odd_value_anew, odd_value_anew, link_in_a_circle, attribute_lost, attribute_of_another_type,
]


LABELS = ("units", "components", "CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST")


def contents_of_hdf5(data):
    """All that the program reads of a file, but the checksums; None if it cannot be read. It reads no labels."""
    found = {}

    def add(name, item):
        for key, value in item.attrs.items():
            if key not in ("checksum", *LABELS):
                found[f"{name}@{key}"] = str(value)
        if isinstance(item, h5py.Dataset):
            found[name] = (str(item.dtype), item.shape, item[()].tobytes() if item.size < 1 << 24 else None)
    try:
        with h5py.File(io.BytesIO(data), "r") as file:
            add("/", file)
            file.visititems(add)
    except Exception:   # h5py raises any of them
        return None
    return found
