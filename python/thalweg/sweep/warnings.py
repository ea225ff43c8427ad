"""The warnings of many runs, each said once with the names of the runs that have it."""
import json
import re
import shutil
import textwrap
from collections import Counter
from concurrent.futures import ThreadPoolExecutor

from thalweg.sweep.machine import cores

MOST_NAMES = 5
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")


def grouped(warnings):
    """warnings: pairs of the name of a run and its list. Sentences with the names of the runs that have them, in the
    order of their first appearance; those of several runs that differ in numbers alone are one, with the numbers of the
    first."""
    found = {}
    for name, sentences in warnings:
        known = Counter()   # of this run
        for sentence in dict.fromkeys(sentences):
            alike = NUMBER.sub("#", sentence)
            first, names = found.setdefault((alike, known[alike]), (sentence, []))
            known[alike] += 1
            names.append(name)
    return list(found.values())


def lines_of(warnings):
    """Lines of text for the terminal."""
    lines = []
    for sentence, names in grouped(warnings):
        shown = ", ".join(names[:MOST_NAMES]) + (
            f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        )
        differ = f" (the numbers are those of {names[0]})" if len(names) > 1 and NUMBER.search(sentence) else ""
        lines += textwrap.wrap(
            f"warning: {shown}{differ}: {sentence}", max(60, shutil.get_terminal_size((120, 24)).columns),
            subsequent_indent="  ", break_long_words=False, break_on_hyphens=False,
        )
    return lines


def said_by_checks(names, checks):
    """Pairs as grouped() takes them. names: of the runs; checks: functions that return a finished process of `thalweg
    check --json`, called beside each other. A case that cannot be run counts as a warning."""
    with ThreadPoolExecutor(max_workers=cores()) as pool:
        return list(zip(names, pool.map(lambda check: sentences_of(check()), checks)))


def sentences_of(check):
    if check.returncode != 0:
        return ["it cannot be run: " + check.stderr.strip().removeprefix("thalweg: ")]
    return json.loads(check.stdout)["warnings"]
