"""Copies a module with the additions of a user: (file of the module, text that it has once, text in place of that).

The additions are those of somebody who follows CONTRIBUTING.md; a C++ test compares their results with theory, and the
test docs.extensions the files that they touch with the table in CONTRIBUTING.md.
"""
import pathlib
import shutil
import sys

Edits = list[tuple[str, str, str]]


def write(repository: pathlib.Path, copy: pathlib.Path, module: str, edits: Edits, added: dict[str, str]) -> None:
    """added: text of new files of the module."""
    texts = {path.relative_to(repository / module).as_posix(): path.read_text()
             for path in sorted((repository / module).rglob("*.[hc]pp"))}
    for name, old, new in edits:
        if texts[name].count(old) != 1:
            sys.exit(f"{module}/{name} has {texts[name].count(old)} times what an extension begins from:\n{old}")
        texts[name] = texts[name].replace(old, new)
    shutil.rmtree(copy / module, ignore_errors=True)
    for name, text in (texts | added).items():
        path = copy / module / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
