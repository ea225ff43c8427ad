"""Mutations of cases: one key removed, misspelt, of another type, negative, zero, huge, tiny, not a number, infinite,
off by a thousand, a list, or given twice."""
import copy
import resource
import sys
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from thalweg.case_file import CaseLoader

BYTES = 6 << 30   # a check measures the memory with 256 MiB

VALUES = [None, True, "text", "", -1, 0, 1, -1e-300, 1e-30, 1e30, 1e308, float("nan"), float("inf"), float("-inf"),
          9223372036854775808, -9223372036854775808, [], {}, [1], [1, 2], [1, 2, 3], [1, 2, 3, 4], [[1]], {"key": 1},
          "1e-3 m", "0x10", "../nowhere", "é", "a: b"]


def keys_of(node, path=()):
    """The paths of all keys and list entries."""
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield path + (key,)
        yield from keys_of(value, path + (key,))


def parent_of(content, path):
    for key in path[:-1]:
        content = content[key]
    return content


def misspelt(key, chance):
    at = chance.randrange(len(key))
    return key[:at] + chance.choice(["", key[at] * 2, "_"]) + key[at + 1:]


def mutated(content, chance):
    """A copy with one thing changed, and what it is in words."""
    content = copy.deepcopy(content)
    path = chance.choice(list(keys_of(content)))
    parent, key = parent_of(content, path), path[-1]
    value = parent[key]
    name = ".".join(map(str, path))
    kind = chance.choice(["remove", "misspell", "value", "value", "value", "scale", "negate", "wrap"])
    if kind == "remove":
        del parent[key]
    elif kind == "misspell" and isinstance(key, str):
        parent[misspelt(key, chance)] = parent.pop(key)
    elif kind in ("scale", "negate") and isinstance(value, (int, float)) and not isinstance(value, bool):
        factor = -1 if kind == "negate" else chance.choice([1e3, 1e-3, 10, 0.1, 1e6, 1e-6])
        parent[key] = type(value)(value * factor) if kind == "negate" else value * factor
    elif kind == "wrap":
        parent[key] = [value]
    else:
        parent[key] = chance.choice(VALUES)
    return content, f"{kind} {name}"


def text_of(content, chance):
    text = yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
    if chance.random() < 0.05:   # a line twice: often a key given twice
        lines = text.splitlines(keepends=True)
        at = chance.randrange(len(lines))
        text = "".join(lines[:at + 1] + lines[at:])
    return text


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
