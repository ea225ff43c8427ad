"""The table of CONTRIBUTING.md has the files that the additions of tests/*/*/extend.py touch."""
import importlib.util
import pathlib
import re

root = pathlib.Path(__file__).resolve().parents[2]
row = re.compile(r"\| [^|]+ \| `([A-Z_]+)` in `([^`]+/extend\.py)` \| (\d+): ([^|(]*(?:\(new\)[^|(]*)?)")


def additions(path):
    """Files that each addition of an extend.py touches, by name."""
    spec = importlib.util.spec_from_file_location("extend", root / path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = {name: {edit[0] for edit in edits} for name, edits in vars(module).items()
             if name.isupper() and isinstance(edits, list)}
    if header := getattr(module, "HEADER", None):
        (only,) = found.values()
        only.add(header)
    return {(name, path): files for name, files in found.items()}


text = (root / "CONTRIBUTING.md").read_text()
table = {
    (name, path): (int(count), set(re.findall(r"`([^`]+)`", files))) for name, path, count, files in row.findall(text)
}
expected = {}
for script in sorted((root / "tests").glob("*/*/extend.py")):
    expected |= additions(script.relative_to(root).as_posix())

assert table.keys() == expected.keys(), f"CONTRIBUTING.md has {sorted(table)}, tests/*/*/extend.py {sorted(expected)}"
for key, files in expected.items():
    assert table[key] == (len(files), files), f"{key} touches {sorted(files)}; CONTRIBUTING.md says {table[key]}"
print(f"{len(table)} additions touch the files that CONTRIBUTING.md names")
