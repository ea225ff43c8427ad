"""The page "Keys of a case", from what `thalweg defaults SYSTEM` prints: each key once, with the systems that have
it."""
import re
from dataclasses import dataclass, field

SYSTEMS = {
    "resolved": "fluid with grains in it",
    "fluid": "fluid alone",
    "grains": "dry grains",
    "model_fluid": "grains under a prescribed fluid force",
    "continuum": "a column of two continua",
}
LINE = re.compile(r"^( *)(# )?(- )?(# )?(\w+):(?: (?! )(.*?))?(?:  +# (.*))?$")
CONTINUED = re.compile(r"\n {44}#   ")   # a comment that takes more than one line
ONLY_WITH = re.compile(r"; only with ([^;]*)$")
INTRODUCTION = """# Keys of a case

Every key of a case file with its default, unit, range and meaning, as `thalweg defaults` prints them for each `system`.
An *example* is a plausible value of a key that has no default. A key is *required* wherever its section is given. `[]`
stands for the entries of a list: `grains[].count` is `grains.0.count` for `--set`. The unit 1 means none.
[The case file](../docs/input.md) explains the concepts.

"""


@dataclass
class Key:
    path: str
    value: str
    kind: str = ""        # unit and range, or the words to choose from
    meaning: str = ""
    only_with: str = ""   # the choice that has the key, where the defaults make another
    required: bool = False
    example: bool = False
    optional: bool = False
    section: bool = False

    @property
    def has_default(self):
        return bool(self.value) and not (self.example or self.required or self.optional)

    @property
    def shown(self):
        """What tells it from the same key of another system; of examples one is enough."""
        return (
            self.value if self.has_default else "", self.kind, self.meaning, self.only_with, self.required,
            self.optional,
        )


@dataclass
class Entry:
    """A key with what the systems say of it: [(systems, key)]."""
    path: str
    variants: list = field(default_factory=list)

    def add(self, system, key):
        for systems, known in self.variants:
            if known.shown == key.shown:
                systems.append(system)
                return
        self.variants.append(([system], key))


def split_outside_brackets(text, separator):
    """The text before and after the first separator that is in no bracket."""
    depth = 0
    for place, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if depth == 0 and text.startswith(separator, place):
            return text[:place], text[place + len(separator):]
    return text, ""


def read_comment(key, comment):
    """Fills in a key what the comment behind it says."""
    match = ONLY_WITH.search(comment)
    if match:
        key.only_with, comment = match.group(1), comment[:match.start()]
    for mark in ("example", "required"):
        if comment.startswith(mark + ", "):
            setattr(key, mark, True)
            comment = comment[len(mark) + 2:]
    kind, meaning = ("", comment) if key.section else split_outside_brackets(comment, ";")
    key.kind, key.meaning = (kind.strip(), meaning.strip()) if meaning or not key.value else ("", comment.strip())


def read_keys(text):
    """All keys of what `thalweg defaults SYSTEM` prints, in order."""
    found, above = [], []   # above: (depth, path) of the sections that the line may be in
    for line in re.sub(CONTINUED, " ", text).split("\n"):
        match = LINE.match(line)
        if not match or line.startswith("# Every key"):
            continue
        indent, commented, item, commented_key, name, value, comment = match.groups()
        depth = len(indent) // 2 + (1 if item else 0)
        while above and above[-1][0] >= depth:
            above.pop()
        parent = ""
        if above:
            in_list = depth - above[-1][0] == 2
            parent = above[-1][1] + ("[]." if in_list else ".")
        key = Key(parent + name, value or "", optional=bool(commented or commented_key), section=not value)
        read_comment(key, comment or "")
        found.append(key)
        above.append((depth, key.path))
    return found


def merged(keys_by_system):
    """The keys of all systems as entries, those of one section together, in the order of the first system that has
    them."""
    entries = {}
    for system, keys in keys_by_system.items():
        before = None
        for key in keys:
            if key.path not in entries:
                entries = inserted(entries, Entry(key.path), before)
            entries[key.path].add(system, key)
            before = key.path
    return entries


def inserted(entries, entry, before):
    """The entries with one more behind that of the path `before`; of another section than that: at the end."""
    same_section = before and section_of(before) == section_of(entry.path)
    if not same_section:
        known = [path for path in entries if section_of(path) == section_of(entry.path)]
        before = known[-1] if known else None
    if before is None:
        return entries | {entry.path: entry}
    result = {}
    for path, old in entries.items():
        result[path] = old
        if path == before:
            result[entry.path] = entry
    return result


def section_of(path):
    return re.split(r"[.\[]", path, 1)[0]


def anchor_of(path):
    return path.replace("[]", ".n")


def escaped(text):
    return re.sub(r"([\\`*_{}\[\]<>|#])", r"\\\1", text)


def described(key):
    """One key as lines of Markdown."""
    words = key.kind.split(" | ")
    facts = []
    if key.value:
        facts.append(f"{'default' if key.has_default else 'example'} `{key.value}`")
    if key.kind and len(words) == 1:
        facts.append(escaped(key.kind))
    if key.only_with:
        facts.append(f"only with `{key.only_with}`")
    if key.required or key.optional:
        facts.append("required" if key.required else "optional")
    lines = [" · ".join(facts)] if facts else []
    if key.meaning:
        lines.append(escaped(key.meaning[0].upper() + key.meaning[1:]) + ".")
    if len(words) > 1:
        lines.append("\n".join("- " + word_line(word) for word in words))
    return lines


def word_line(word):
    name, _, meaning = word.partition(" (")
    return f"`{name}`" + (f": {escaped(meaning.removesuffix(')'))}" if meaning else "")


def entry_text(entry, systems):
    level = "##" if "." not in entry.path and "[" not in entry.path else "###"
    lines = [f"{level} {escaped(entry.path)} {{#{anchor_of(entry.path)}}}"]
    for of, key in entry.variants:
        if len(of) < len(systems):
            lines.append("*system: " + ", ".join(of) + "*")
        lines += described(key)
    return "\n\n".join(lines) + "\n\n"


def page(printed):
    """The page, from {system: what `thalweg defaults` prints of it}."""
    entries = merged({system: read_keys(text) for system, text in printed.items()})
    systems = "".join(f"- `{system}`: {meaning}\n" for system, meaning in SYSTEMS.items() if system in printed)
    return INTRODUCTION + systems + "\n" + "".join(entry_text(entry, printed) for entry in entries.values())
