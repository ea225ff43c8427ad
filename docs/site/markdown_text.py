"""Links and headings of a Markdown text as GitHub reads it: shared by the check of links and the site of the
documentation."""
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import unquote

SKIPPED_FOLDERS = {".git", "build", "run", "scratch", "__pycache__"}   # beside the sources, and generated

FENCE = re.compile(r"^ {0,3}(`{3,}|~{3,})")
CODE_SPAN = re.compile(r"(?<!`)(`+)(?!`)(.+?)(?<!`)\1(?!`)", re.DOTALL)
INDENTED = re.compile(r"^( {4,}|\t)\S")
LIST_ITEM = re.compile(r"^( *)([-*+]|\d+[.)]) +")
INLINE_LINK = re.compile(r"\]\(\s*(<[^<>\n]*>|[^\s()<]*(?:\([^\s()]*\)[^\s()]*)*)(?:\s+(?:\"[^\"]*\"|'[^']*'))?\s*\)")
DEFINITION = re.compile(r"^ {0,3}\[[^\]\n]+\]:\s*(\S+)", re.MULTILINE)
HTML_LINK = re.compile(r"<(?:a|img)\b[^>]*?\b(?:href|src)\s*=\s*[\"']([^\"']*)[\"']", re.IGNORECASE)
HTML_ANCHOR = re.compile(r"<[a-z]+\b[^>]*?\b(?:id|name)\s*=\s*[\"']([^\"']*)[\"']", re.IGNORECASE)
HEADING = re.compile(r"^ {0,3}(#{1,6})[ \t]+(.*?)(?:[ \t]+#+)?[ \t]*$")
SCHEME = re.compile(r"^([a-z][a-z0-9+.-]*:|//)", re.IGNORECASE)


@dataclass(frozen=True)
class Link:
    target: str
    line: int    # from 1
    start: int   # of the target in the text
    end: int

    @property
    def is_external(self):
        return bool(SCHEME.match(self.target))

    @property
    def path(self):
        return unquote(self.target.partition("#")[0])

    @property
    def anchor(self):
        return unquote(self.target.partition("#")[2])


def blank(text):
    return re.sub(r"[^\n]", " ", text)


def without_fences(text):
    """The text with fenced code as spaces, every character in its place."""
    lines, fence = [], None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        inside = fence is not None
        if inside and mark and mark.group(1).startswith(fence) and not line.strip().strip(fence[0]):
            fence = None
        elif not inside and mark:
            fence = mark.group(1)
        lines.append(blank(line) if inside or mark else line)
    return "\n".join(lines)


def without_blocks(text):
    """The text with fenced and indented code as spaces, every character in its place."""
    lines, in_code, in_list, before_blank = [], False, 0, True
    for line in without_fences(text).split("\n"):
        item = LIST_ITEM.match(line)
        if item and not in_code:
            in_list = item.end()
        elif line.strip() and before_blank and not line.startswith(" "):
            in_list = 0
        inner = line[in_list:] if not line[:in_list].strip() else line
        in_code = bool(INDENTED.match(inner)) and (before_blank or in_code) and not (item and not in_list)
        lines.append(blank(line) if in_code else line)
        before_blank = not line.strip()
    return "\n".join(lines)


def without_code(text):
    """The text with all code as spaces, every character in its place."""
    return CODE_SPAN.sub(lambda match: blank(match.group()), without_blocks(text))


def links(text):
    """All links and pictures of a text, in order."""
    plain = without_code(text)
    found = []
    for pattern in (INLINE_LINK, DEFINITION, HTML_LINK):
        for match in pattern.finditer(plain):
            start, end = match.span(1)
            if text[start:end].startswith("<"):
                start, end = start + 1, end - 1
            found.append(Link(text[start:end], text.count("\n", 0, start) + 1, start, end))
    return sorted(found, key=lambda link: link.start)


def headings(text):
    """(line from 0, level, text) of each heading that begins with #."""
    for number, (plain, line) in enumerate(zip(without_blocks(text).split("\n"), text.split("\n"))):
        match = HEADING.match(line)
        if match and plain.strip():
            yield number, len(match.group(1)), match.group(2)


def shown_text(heading):
    """What of a heading is seen: no marks of links, code and emphasis."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    text = re.sub(r"`+", "", text)
    return re.sub(r"(?<!\w)[*_]{1,3}(?=\S)|(?<=\S)[*_]{1,3}(?!\w)", "", text)


def slug(heading):
    """The anchor that GitHub gives to a heading, but for repetitions."""
    return re.sub(r"[^\w\- ]", "", shown_text(heading).strip().lower()).replace(" ", "-")


def heading_anchors(text):
    """[(line from 0, anchor)] of the headings: a second one of the same name ends with -1, the next with -2."""
    seen, result = Counter(), []
    for line, _, heading in headings(text):
        name = slug(heading)
        result.append((line, f"{name}-{seen[name]}" if seen[name] else name))
        seen[name] += 1
    return result


def anchors(text):
    return {anchor for _, anchor in heading_anchors(text)} | set(HTML_ANCHOR.findall(without_code(text)))


def title(text):
    """The first heading, as it is seen."""
    return next((shown_text(heading) for _, _, heading in headings(text)), "")


def markdown_files(root):
    """All Markdown files under a folder, without generated ones, relative to it."""
    return [path.relative_to(root) for path in sorted(Path(root).rglob("*.md"))
            if not SKIPPED_FOLDERS.intersection(path.relative_to(root).parts)]
