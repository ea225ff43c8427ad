#!/usr/bin/env python3
"""Checks that the modules depend on each other only as docs/architecture.md says.

    check_includes.py [ROOT]      of the repository (default: the one this file is in)

- A module includes, and its CMake target links, only the modules it may depend on; only tests use driver.
- A room (a folder of a module) includes only itself and the rooms before it; a module's own folder comes after its
rooms.
- No room has more than MOST_FILES files.
- VTK and HDF5 appear only in io, and a header of io that shows them is not included from elsewhere; yaml-cpp appears
  only in io and driver.
- Includes are written from the repository root, and what they name exists.
- Wherever all modules are listed, all of them are; scripts/check and scripts/coverage take the list of CMakeLists.txt.
- No file carries a note that something is left to do.

Prints one line per violation and exits with 1 if there is any.
"""
import pathlib
import re
import sys

MODULES = {
    "core": {"core"},
    "lbm": {"core", "lbm"},
    "bodies": {"core", "lbm", "bodies"},
    "dem": {"core", "dem"},
    "beds": {"core", "dem", "beds"},
    "model_fluid": {"core", "dem", "model_fluid"},
    "continuum": {"core", "continuum"},
    "analysis": {"core", "analysis"},
    "io": {"core", "io"},
    "coupling": {"core", "lbm", "bodies", "dem", "coupling"},
    "loop": {"core", "analysis", "loop"},
    "driver": {"core", "lbm", "bodies", "dem", "beds", "model_fluid", "continuum", "analysis", "io", "coupling", "loop",
               "driver"},
}
# The rooms of each module, from the ground floor up.
ROOMS = {
    "core": ("base", "geometry", "keys", "parallel", "state", "sums"),
    "lbm": ("lattice", "collision", "walls", "fluid"),
    "bodies": ("map", "links"),
    "dem": ("laws", "motion", "clumps", "contact", "ranks", "supply"),
    "beds": ("packing", "sizes", "shapes", "population", "files"),
    "model_fluid": (),
    "coupling": ("loads", "keys", "system"),
    "continuum": (),
    "analysis": ("observer", "statistics", "tools", "bed", "sizes", "reach", "observers"),
    "io": ("files", "text", "vtk", "hdf5", "folder"),
    "loop": (),
    "driver": ("case", "bed", "estimate", "input", "setup", "cost", "execution", "warnings", "plan", "cli"),
}
MOST_FILES = 27   # of one room: more cannot be drawn from memory
# Files with a list of the modules, and the modules that it need not have.
LISTS = {
    "CMakeLists.txt": set(),
    "tests/CMakeLists.txt": set(),
    "cmake/install.cmake": {"driver"},
    "docs/site/Doxyfile": set(),
}
BEGIN_OF_LIST = re.compile(r"^.*\bcore lbm\b.*$", re.MULTILINE)
# Whoever else may use the driver: its own tests, tests of the whole program, and measurements of whole cases.
USERS_OF_DRIVER = ("driver/", "tests/driver/", "tests/system/", "benchmarks/")
SOURCE_SUFFIXES = {".hpp", ".cpp", ".ipp", ".h", ".cc"}
TEXT_SUFFIXES = SOURCE_SUFFIXES | {".py", ".md", ".txt", ".cmake", ".yaml", ".json", ".sh", ".cff", ".csv", ""}
SKIPPED_FOLDERS = {".git", "build", "run", "__pycache__"}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)
TARGET = re.compile(r"thalweg(?:::|_)(\w+)")
VTK_OR_HDF5 = re.compile(r"^(vtk\w*\.h|hdf5(_hl)?\.h|H5\w*\.h)$", re.IGNORECASE)
YAML = re.compile(r"^yaml-cpp/")
UNFINISHED = re.compile(r"\b(?:" + "|".join(("TO" + "DO", "FIX" + "ME", "XX" + "X", "HA" + "CK")) + r")\b")


def module_of(relative):
    """The module a file belongs to: its own folder, or for a test the one it tests."""
    return relative.parts[1] if relative.parts[0] == "tests" and len(relative.parts) > 2 else relative.parts[0]


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def files_of(root):
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root)
        if path.is_file() and not SKIPPED_FOLDERS.intersection(relative.parts[:-1]):
            yield path, relative


def headers_that_show_vtk_or_hdf5(root):
    """The headers of io that include VTK or HDF5, directly or through another header of io."""
    includes = {path.relative_to(root).as_posix(): [name for _, name in INCLUDE.findall(path.read_text())]
                for path in (root / "io").rglob("*.hpp")}
    shown = set()
    while True:
        more = {header for header, names in includes.items()
                if any(VTK_OR_HDF5.match(name) or name in shown for name in names)}
        if more == shown:
            return shown
        shown = more


def room_of(relative):
    """The room of a file of a module; empty: the module's own folder."""
    return relative.parts[1] if len(relative.parts) > 2 else ""


def check_floors(relative, name):
    """What is wrong with an include of a file of the same module, or None."""
    module = relative.parts[0]
    floors = ROOMS[module] + ("",)
    here, there = room_of(relative), room_of(pathlib.PurePosixPath(name))
    if here in floors and there in floors and floors.index(there) > floors.index(here):
        return f'{module}/{here} must not include "{name}": {there or "the folder of " + module} comes after it'
    return None


def check_rooms(root):
    """(file, line, what) of every folder of a module that is no room, or has too many files."""
    for module, rooms in ROOMS.items():
        if not (root / module).is_dir():
            continue
        folders = {path.parent for path in (root / module).rglob("*") if path.suffix in SOURCE_SUFFIXES}
        for folder in sorted(folders):
            relative = folder.relative_to(root)
            if relative.parts[1:] and (len(relative.parts) > 2 or relative.parts[1] not in rooms):
                yield relative, 1, f"check_includes.py does not know this room of {module}"
            files = sum(path.suffix in SOURCE_SUFFIXES for path in folder.iterdir())
            if files > MOST_FILES:
                yield relative, 1, f"{files} files in one room; no room has more than {MOST_FILES}"


def check_quoted(root, relative, name, private):
    """What is wrong with #include "name" in a file, or None."""
    module, target = relative.parts[0], name.split("/")[0]
    if "/" not in name or target in (".", ".."):
        return f'"{name}" is not written from the repository root'
    if not (root / name).is_file():
        return f'"{name}" does not exist in this repository (other people\'s headers go in <>)'
    if module in MODULES and target not in MODULES[module]:
        allowed = ", ".join(sorted(MODULES[module] - {module})) or "no other"
        return f'{module} must not include "{name}": it may depend on {allowed}'
    if module in MODULES and target == module:
        wrong = check_floors(relative, name)
        if wrong:
            return wrong
    if name in private and module_of(relative) != "io":
        return f'"{name}" shows VTK or HDF5, which are private to io'
    if target == "driver" and not relative.as_posix().startswith(USERS_OF_DRIVER):
        return f'only the program and its tests include the driver ("{name}")'
    return None


def check_foreign(relative, name):
    """What is wrong with #include <name> in a file, or None."""
    module = module_of(relative)
    if VTK_OR_HDF5.match(name) and module not in ("io", "system"):
        return f"<{name}> belongs in io alone"
    if YAML.match(name) and module not in ("io", "driver"):
        return f"<{name}> belongs in io and driver alone"
    if name.split("/")[0] in MODULES and "/" in name:
        return f'<{name}> is a header of this repository: write "{name}"'
    return None


def check_source(root, relative, text, private):
    for match in INCLUDE.finditer(text):
        own, name = match.group(1) == '"', match.group(2)
        wrong = check_quoted(root, relative, name, private) if own else check_foreign(relative, name)
        if wrong:
            yield line_of(text, match.start()), wrong


def check_targets(relative, text):
    """A module's CMakeLists.txt may name only the targets of the modules it may depend on."""
    module = relative.parts[0]
    for match in TARGET.finditer(text):
        target = match.group(1)
        if target in MODULES and target not in MODULES[module]:
            yield line_of(text, match.start()), f"{module} must not link thalweg::{target}"


def check_lists(root):
    """(file, line, what) of every module that a list has forgotten."""
    for name, others in LISTS.items():
        if not (root / name).is_file():
            continue
        text = (root / name).read_text(encoding="utf-8")
        for match in BEGIN_OF_LIST.finditer(text):
            for module in sorted(MODULES.keys() - others - set(re.findall(r"\w+", match.group()))):
                yield pathlib.Path(name), line_of(text, match.start()), f"this list of modules leaves out {module}"
            unknown = set(re.findall(r"\w+", match.group())) - MODULES.keys() - {"foreach", "module"}
            for module in sorted(unknown) if name == "CMakeLists.txt" else ():
                yield pathlib.Path(name), line_of(text, match.start()), \
                    f"check_includes.py does not know what the module {module} may depend on"


def violations(root):
    """(file, line, what) of everything that is wrong."""
    private = headers_that_show_vtk_or_hdf5(root)
    yield from check_lists(root)
    yield from check_rooms(root)
    for path, relative in files_of(root):
        if path.suffix not in TEXT_SUFFIXES:
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue   # not a text
        found = []
        if path.suffix in SOURCE_SUFFIXES:
            found += check_source(root, relative, text, private)
        if path.name == "CMakeLists.txt" and relative.parts[0] in MODULES:
            found += check_targets(relative, text)
        found += [(line_of(text, m.start()), f'"{m.group()}": finish it, or say in an issue what is missing')
                  for m in UNFINISHED.finditer(text)]
        for line, what in found:
            yield relative, line, what


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    modules = [module for module in MODULES if (root / module).is_dir()]
    if not modules:
        print(f"check_includes: {root} holds no module of Thalweg.", file=sys.stderr)
        return 2
    found = list(violations(root))
    for relative, line, what in found:
        print(f"{relative}:{line}: {what}")
    print(f"{len(found)} violation{'' if len(found) == 1 else 's'} in {', '.join(modules)}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
