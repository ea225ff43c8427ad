#!/usr/bin/env python3
"""Finds dead links in the Markdown files of the repository.

    check_links.py [ROOT]      of the repository (default: the one this file is in)

A relative link or picture must name a file or folder of the repository, by a path that stays inside it and does not
lead into generated folders (build, run); an anchor must be that of a heading of the page, as GitHub forms it. Links
with a scheme (https:) are not followed. Prints one line per dead link and exits with 1 if there is any.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/site"))
import markdown_text


def page_of(path):
    """The Markdown file that a link to this file or folder shows, or None."""
    if path.is_dir():
        path = path / "README.md"
    return path if path.suffix == ".md" and path.is_file() else None


def fault(root, page, link):
    """What is wrong with a link of a page, or None."""
    if link.is_external:
        return None
    if not link.target:
        return "names nothing"
    if link.path.startswith("/"):
        return "is not relative"
    target = (root / page).parent / link.path if link.path else root / page
    resolved = target.resolve()
    if not resolved.is_relative_to(root):
        return "leads out of the repository"
    if markdown_text.SKIPPED_FOLDERS.intersection(resolved.relative_to(root).parts):
        return "leads to a generated file"
    if not resolved.exists():
        return "does not exist"
    if not link.anchor:
        return None
    shown = page_of(resolved)
    if shown is None:
        return "has an anchor, but is no Markdown page"
    if link.anchor not in markdown_text.anchors(shown.read_text(encoding="utf-8")):
        return f'has no heading for "#{link.anchor}"'
    return None


def dead_links(root):
    """(page, line, target, what is wrong) of every dead link."""
    root = pathlib.Path(root).resolve()
    for page in markdown_text.markdown_files(root):
        for link in markdown_text.links((root / page).read_text(encoding="utf-8")):
            wrong = fault(root, page, link)
            if wrong:
                yield page, link.line, link.target, wrong


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2]
    pages = markdown_text.markdown_files(root)
    if not pages:
        print(f"check_links: {root} holds no Markdown file.", file=sys.stderr)
        return 2
    found = list(dead_links(root))
    for page, line, target, wrong in found:
        print(f"{page}:{line}: {target} {wrong}")
    print(f"{len(found)} dead link{'' if len(found) == 1 else 's'} in {len(pages)} Markdown files")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
