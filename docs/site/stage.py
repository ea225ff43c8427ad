#!/usr/bin/env python3
"""Makes a copy of the documentation from which mkdocs builds the site (scripts/docs).

    stage.py FOLDER THALWEG      into this folder, with the keys that this program prints

The Markdown files of the repository keep their places, so that links between them still hold. Only what GitHub and
mkdocs read differently is adapted in the copy: links to folders, links to files that the site does not have, anchors
and lists. The navigation is that of docs/site/mkdocs.yml, where an entry FOLDER/* stands for all pages in this folder.
"""
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

import keys
import markdown_text

ROOT = Path(__file__).resolve().parents[2]
KEYS_PAGE = "reference/keys.md"
LIBRARIES = "libraries/index.html"   # made by Doxygen
COPIED_SUFFIXES = {".png", ".svg", ".yaml", ".csv", ".cff", ".gif"}


def site_target(root, page, link):
    """What a link of a page becomes on the site; None: the site does not have it."""
    if link.is_external or not link.path:
        return link.target
    target = ((root / page).parent / link.path).resolve()
    anchor = f"#{link.anchor}" if link.anchor else ""
    if target.is_dir():
        return link.path.rstrip("/") + "/README.md" + anchor if (target / "README.md").is_file() else None
    return link.path + anchor if target.suffix in COPIED_SUFFIXES | {".md"} else None


def with_site_links(root, page, text):
    """The text with the links of the site; a link that it does not have leaves its words."""
    for link in reversed(markdown_text.links(text)):
        target = site_target(root, page, link)
        if target is not None:
            text = text[:link.start] + target + text[link.end:]
            continue
        opening = text.rfind("[", 0, link.start)
        words = text[opening + 1:text.rfind("]", 0, link.start)]
        text = text[:opening] + words + text[text.index(")", link.end) + 1:]
    return text


def with_anchors(text):
    """The text with the anchor of every heading written out, since mkdocs would form some differently."""
    lines = text.split("\n")
    for line, anchor in markdown_text.heading_anchors(text):
        lines[line] += f" {{#{anchor}}}"
    return "\n".join(lines)


def with_wide_lists(text):
    """The text with a blank line before each list and entries indented by four, which Python-Markdown asks for."""
    lines, inside, result = markdown_text.without_fences(text).split("\n"), [], []
    for plain, line in zip(lines, text.split("\n")):
        item, indent = markdown_text.LIST_ITEM.match(plain), len(line) - len(line.lstrip())
        if not line.strip() or (plain != line and not inside):
            result.append(line)
            continue
        after_list = bool(inside)
        while inside and indent < inside[-1] and (item or not result[-1].strip() or indent == 0):
            inside.pop()
        if item and (not inside or indent >= inside[-1]):
            if not after_list and result and result[-1].strip():
                result.append("")
            inside.append(item.end())
            result.append("    " * (len(inside) - 1) + line[indent:])
        elif inside:
            result.append("    " * len(inside) + line[min(indent, inside[-1]):])
        else:
            result.append(line)
    return "\n".join(result)


def staged_page(root, page):
    text = with_site_links(root, page, (root / page).read_text(encoding="utf-8"))
    return with_wide_lists(with_anchors(text))


def copy_pages(root, folder):
    """Copies all Markdown files, and the files that they link to."""
    pages = markdown_text.markdown_files(root)
    for page in pages:
        (folder / page).parent.mkdir(parents=True, exist_ok=True)
        (folder / page).write_text(staged_page(root, page), encoding="utf-8")
        for link in markdown_text.links((root / page).read_text(encoding="utf-8")):
            target = None if link.is_external else ((root / page).parent / link.path).resolve()
            if target and target.is_file() and target.suffix in COPIED_SUFFIXES:
                copy = folder / target.relative_to(root)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(target, copy)
    return pages


def label(root, page):
    return markdown_text.title((root / page).read_text(encoding="utf-8"))


def expanded(root, entries, pages, used):
    """The navigation with FOLDER/* as its pages that are named nowhere, and every page with its title."""
    result = []
    for entry in entries:
        name, value = next(iter(entry.items())) if isinstance(entry, dict) else (None, entry)
        if isinstance(value, list):
            result.append({name: expanded(root, value, pages, used)})
        elif value.endswith("/*"):
            inside = [page for page in pages if page.is_relative_to(value[:-2]) and page.as_posix() not in used]
            used.update(page.as_posix() for page in inside)
            result += [{label(root, page): page.as_posix()} for page in inside]
        else:
            result.append({name or label(root, value): value})
    return result


def named(entries):
    """The pages that a navigation names."""
    for entry in entries:
        value = next(iter(entry.values())) if isinstance(entry, dict) else entry
        yield from named(value) if isinstance(value, list) else [value]


def navigation(root, entries, pages):
    """The navigation of the site; ValueError if a page is in none of its entries."""
    used = {name for name in named(entries) if not name.endswith("/*")}
    result = expanded(root, entries, pages, used)
    missing = [page.as_posix() for page in pages if page.as_posix() not in used]
    if missing:
        raise ValueError(f"docs/site/mkdocs.yml has no place in its navigation for {', '.join(missing)}")
    return result


def configuration(root, pages):
    settings = yaml.safe_load((root / "docs/site/mkdocs.yml").read_text(encoding="utf-8"))
    return settings | {"nav": navigation(root, settings["nav"], pages)}


def printed_keys(program):
    return {system: subprocess.run([program, "defaults", system], check=True, capture_output=True, text=True).stdout
            for system in keys.SYSTEMS}


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(sys.argv[1])
    pages_folder = folder / "pages"
    shutil.rmtree(folder, ignore_errors=True)
    pages = copy_pages(ROOT, pages_folder)
    (pages_folder / KEYS_PAGE).parent.mkdir(parents=True, exist_ok=True)
    (pages_folder / KEYS_PAGE).write_text(keys.page(printed_keys(sys.argv[2])), encoding="utf-8")
    try:
        settings = configuration(ROOT, pages)
    except ValueError as error:
        print(f"docs: {error}", file=sys.stderr)
        return 1
    (folder / "mkdocs.yml").write_text(json.dumps(settings, indent=1), encoding="utf-8")   # JSON is YAML
    return 0


if __name__ == "__main__":
    sys.exit(main())
