"""A header as Doxygen reads it: its // comments as documentation of what they stand before or behind.

    doxygen_comments.py HEADER     prints it
"""
import re
import sys

ALONE = re.compile(r"^(\s*)//(?: (.*)|)$")
BEHIND = re.compile(r"^(\s*[^\s/].*?[;,{}]|\s*\w[^/;]*?)(\s+)// (.*)$")
SKIPPED = re.compile(r"^\s*(#|\}\s*// namespace|namespace\b)")
MARKUP = re.compile(r"([\\@<>#&%])")


def escaped(text):
    """Without what Doxygen would take for commands and tags."""
    return MARKUP.sub(r"\\\1", text)


def documented(lines):
    column = None   # of a comment behind code, which may go on in the next line
    for line in lines:
        alone, behind = ALONE.match(line), None if SKIPPED.match(line) else BEHIND.match(line)
        if alone and column is not None and len(alone.group(1)) == column:
            yield f"{alone.group(1)}///< {escaped(alone.group(2) or '')}"
        elif alone:
            column = None
            yield f"{alone.group(1)}/// {escaped(alone.group(2) or '')}".rstrip()
        elif behind and "//" not in behind.group(1):
            column = len(behind.group(1)) + len(behind.group(2))
            yield f"{behind.group(1)}{behind.group(2)}///< {escaped(behind.group(3))}"
        else:
            column = None
            yield line


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        lines = file.read().split("\n")
    if lines and ALONE.match(lines[0]):
        print("/// \\file")   # the comment at the head is about the file
    print("\n".join(documented(lines)))


if __name__ == "__main__":
    main()
