"""Case files and sweeps as the solver reads them: io/text/yaml_document.hpp and io/text/section_reader.hpp.

Words are numbers where they are decimal, as in YAML 1.2: 010 is ten and 1e-3 a number; 1:30, 0x10, 1_000, no and
2026-01-01 are texts, which YAML 1.1 takes for other things. Tags (!!int) and merge keys (<<) mean nothing, and a key
given twice is an error.
"""
import json
import math
import re
from pathlib import Path

import yaml

PREFIX = "tag:yaml.org,2002:"


class CaseLoader(yaml.SafeLoader):
    """For yaml.load()."""
    yaml_implicit_resolvers = {}   # in place of those of YAML 1.1

    def compose_node(self, parent, index):
        known = self.anchors.get(self.peek_event().anchor) if self.check_event(yaml.AliasEvent) else None
        if known is not None and known.end_mark is None:   # it would have no end
            mark = self.peek_event().start_mark
            raise yaml.composer.ComposerError(None, None, "an alias is part of what it stands for", mark)
        return super().compose_node(parent, index)

    def compose_scalar_node(self, anchor):
        event = self.peek_event()
        if event.tag not in (None, "!"):
            event.tag = PREFIX + "str"
        return super().compose_scalar_node(anchor)

    def compose_sequence_node(self, anchor):
        self.peek_event().tag = None
        return super().compose_sequence_node(anchor)

    def compose_mapping_node(self, anchor):
        self.peek_event().tag = None
        return super().compose_mapping_node(anchor)

    def construct_mapping(self, node, deep=False):
        known = {}
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise yaml.constructor.ConstructorError(None, None, "a key is not a word", key.start_mark)
            if key.value in known:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {key.value} is given twice", key.start_mark
                )
            known[key.value] = key
        return super().construct_mapping(node, deep)

    def construct_number(self, node):
        """A text where a double has no such number, as the solver then refuses it."""
        word = node.value
        number = float(word)
        underflow = number == 0.0 and re.search("[1-9]", re.split("[eE]", word)[0])
        if math.isinf(number) or underflow:
            return word
        return int(word) if re.fullmatch(r"[-+]?\d+", word) else number


CaseLoader.add_implicit_resolver(PREFIX + "null", re.compile(r"^(~|null|Null|NULL|)$"), ["~", "n", "N", ""])
CaseLoader.add_implicit_resolver(PREFIX + "bool", re.compile(r"^(true|false)$"), list("tf"))
CaseLoader.add_implicit_resolver(PREFIX + "float", re.compile(r"^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?$"),
                                 list("-+.0123456789"))
CaseLoader.add_constructor(PREFIX + "float", lambda loader, node: loader.construct_number(node))


class Whole(int):
    """A number with its `word` in the file, which a text would be: a folder may be called 010."""


class Real(float):
    """The same."""


class WordLoader(CaseLoader):
    """As CaseLoader, but numbers know their words."""

    def construct_number(self, node):
        value = super().construct_number(node)
        if isinstance(value, str):
            return value
        number = Whole(value) if isinstance(value, int) else Real(value)
        number.word = node.value
        return number


def setting_of(value):
    """A value as `thalweg run --set KEY=VALUE` takes it: JSON, and numbers by their words."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)}: {setting_of(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(setting_of(inner) for inner in value) + "]"
    return getattr(value, "word", None) or json.dumps(value)


def read_case(path):
    """A case file as a dictionary."""
    return yaml.load(Path(path).read_text(encoding="utf-8"), CaseLoader)
