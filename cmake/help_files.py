#!/usr/bin/env python3
"""Completion for bash and zsh, the manual page and the schema of cases, made from what the program prints:
help_files.py THALWEG FOLDER

Writes thalweg.bash, _thalweg and thalweg.1 into the folder.
"""
import os
import re
import subprocess
import sys
from pathlib import Path

OPTION = re.compile(r"^ {2}(-[^\s,]+(?:, ?-[^\s,]+)*)((?: (?!Excludes:)\S+)*)(?: Excludes:[^\n]*?)?(?: {2,}(.*))?$")
COMMAND = re.compile(r"^ {2,4}([a-z]\w*)(?: {2,}(.*))?$")
POSITIONAL = re.compile(r"^ {2}([A-Z]\S*)(?: TEXT)?(?: REQUIRED)?(?: \.\.\.)?(?: {2,}(.*))?$")
LISTS = {
    "Subcommands:": "commands", "kinds:": "commands", "Options:": "options", "options:": "options",
    "Positionals:": "positionals", "positional arguments:": "positionals",
}
PATTERNS = {"commands": COMMAND, "options": OPTION, "positionals": POSITIONAL}


class Help:
    """What `thalweg PATH --help` says; path: words of a command. Lists of [words, value, text]; footer: what follows
    them."""

    def __init__(self, program, path):
        self.path, self.commands, self.options, self.positionals, self.summary = path, [], [], [], ""
        said = subprocess.run(
            [program, *path, "--help"], capture_output=True, check=True, encoding="utf-8",
            env=os.environ | {"COLUMNS": "999"},
        )
        head, _, self.footer = said.stdout.partition("\nExamples:\n")
        current = None
        for line in head.splitlines():
            current = LISTS.get(line, current if line.startswith(" ") else None)
            if current:
                self.take(line, current)
            elif line and not line.startswith(("usage:", "Usage:", " ")) and line not in LISTS and not self.summary:
                self.summary = line
        self.below = [Help(program, [*path, command[0]]) for command in self.commands]

    def take(self, line, kind):
        entries = getattr(self, kind)
        match = PATTERNS[kind].match(line)
        if kind == "options" and match:
            entries.append(
                [re.split(r", ?", match[1]), (match[2] or "").strip().partition(":value in")[0], match[3] or ""]
            )
        elif match and match[1] != "KIND":
            entries.append([match[1], "", match[2] or ""])
        elif entries and line.startswith(" " * 8):
            entries[-1][2] = f"{entries[-1][2]} {line.strip()}".strip()

    def all(self):
        return [self, *(found for below in self.below for found in below.all())]

    @property
    def words(self):
        return [word for option in self.options for word in option[0]]


def bash_completion(root):
    lines = [
        "# Completion of thalweg for bash; made from its help.",
        "_thalweg() {", "  local current=${COMP_WORDS[COMP_CWORD]} path= word",
        "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do", "    case \"$path/$word\" in",
    ]
    lines += [f"      /{'/'.join(found.path)}) path=/{'/'.join(found.path)} ;;" for found in root.all() if found.path]
    lines += ["    esac", "  done", "  local options= commands=", "  case $path in"]
    for found in root.all():
        place = f"/{'/'.join(found.path)}" if found.path else "''"
        lines.append(
            f"    {place}) options='{' '.join(found.words)}'"
            f" commands='{' '.join(command[0] for command in found.commands)}' ;;"
        )
    lines += [
        "  esac", "  if [[ $current == -* ]]; then", "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))",
        "  elif [[ -n $commands ]]; then", "    COMPREPLY=($(compgen -W \"$commands\" -- \"$current\"))", "  else",
        "    COMPREPLY=($(compgen -f -- \"$current\"))", "  fi", "}", "complete -o filenames -F _thalweg thalweg", "",
    ]
    return "\n".join(lines)


def zsh_text(text):
    return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")


def zsh_function(found):
    name = "_".join(["_thalweg", *found.path])
    specs = []
    for words, value, text in found.options:
        argument = f":{zsh_text(value)}:_files" if value else ""
        specs += [f"'{word}[{zsh_text(text)}]{argument}'" for word in words]
    lines = [f"{name}() {{"]
    if not found.commands:
        return "\n".join([*lines, f"  _arguments {' '.join(specs)} '*:file:_files'", "}"])
    described = " ".join(f"'{command[0]}:{zsh_text(command[2])}'" for command in found.commands)
    cases = [f"        {below.path[-1]}) {'_'.join(['_thalweg', *below.path])} ;;" for below in found.below]
    return "\n".join(
        [
            *lines, "  local line state",
            f"  _arguments -C {' '.join(specs)} '1:command:->command' '*::argument:->argument'", "  case $state in",
            f"    command) local -a known=({described}); _describe command known ;;", "    argument)",
            "      case $line[1] in", *cases, "      esac ;;", "  esac", "}",
        ]
    )


def zsh_completion(root):
    return "\n".join(
        [
            "#compdef thalweg",
            "# Completion of thalweg for zsh; made from its help.",
            *(zsh_function(found) for found in root.all()), '_thalweg "$@"', "",
        ]
    )


def roff(text):
    """Text that means itself in a manual page."""
    return "\n".join(
        f"\\&{line}" if line.startswith((".", "'")) else line
        for line in text.replace("\\", "\\e").replace("-", "\\-").splitlines()
    )


def manual_of(found):
    name = " ".join(["thalweg", *found.path])
    arguments = " ".join(positional[0] for positional in found.positionals)
    lines = [f".SS {roff(name)} {roff(arguments)}".rstrip(), roff(found.summary)]
    for words, value, text in found.positionals + found.options:
        heads = ", ".join(f"\\fB{roff(word)}\\fR" for word in (words if isinstance(words, list) else [words]))
        lines += [".TP", heads + (f" \\fI{roff(value)}\\fR" if value else ""), roff(text)]
    return "\n".join(lines)


def manual(root, version):
    title, _, summary = root.summary.partition(": ")
    examples, _, codes = root.footer.partition("\n\n")
    parts = [
        f'.TH THALWEG 1 "" "{roff(version)}"', ".nh", ".ad l", ".SH NAME", f"{roff(title.lower())} \\- {roff(summary)}",
        ".SH SYNOPSIS", "\\fBthalweg\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]", ".SH COMMANDS",
        *(manual_of(found) for found in root.all() if found.path), ".SH EXAMPLES", ".nf", roff(examples), ".fi",
        ".SH EXIT STATUS", roff(codes.removeprefix("Exit codes: ")),
    ]
    return "\n".join(parts) + "\n"


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    root = Help(program, [])
    version = subprocess.run([program, "--version"], capture_output=True, check=True, encoding="utf-8").stdout.strip()
    folder.mkdir(parents=True, exist_ok=True)
    schema = subprocess.run([program, "defaults", "--schema"], capture_output=True, check=True, encoding="utf-8").stdout
    for name, text in (
        ("thalweg.bash", bash_completion(root)), ("_thalweg", zsh_completion(root)),
        ("thalweg.1", manual(root, version)), ("thalweg.schema.json", schema),
    ):
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
