"""check_links.py accepts links that work and reports every kind of dead link, each planted alone."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_links
import markdown_text

CORRECT = {
    "README.md": (
        "# Start\n\n[a](docs/a.md), [part](docs/a.md#two-words), [here](#start), [folder](docs), ![p](docs/p.png)\n"
        "[b](docs/b.md \"title\"), [in\ntwo lines](docs/a.md), [web](https://example.org/none), [m](mailto:a@b.c)\n"
    ),
    "docs/a.md": (
        "# A\n\n## Two words\n\n## Two words\n\n[second](#two-words-1), [up](../README.md#start), [x](b.md#x_y-34)\n"
    ),
    "docs/b.md": (
        "# b\n\n## `x_y` (3/4)\n\n[![picture](p.png)](p.png), <img src=\"p.png\">, [ref]\n\n[ref]: a.md#a\n\n"
        "```\n[code](gone.md)\n```\n\n    [code](gone.md)\n\n`[code](gone.md)`\n\n- item\n\n      [code](gone.md)\n"
    ), "docs/p.png": "",
    "build/generated.md": "[gone](gone.md)\n",  # not ours to check
}

# (text of a page in docs, a piece of the complaint)
PLANTED = [
    ("[dead](gone.md)", "does not exist"),
    ("[dead](../a.md)", "does not exist"),
    ("![dead](gone.png)", "does not exist"),
    ("[![dead](gone.png)](a.md)", "does not exist"),
    ("[![picture](p.png)](gone.png)", "does not exist"),
    ("[dead](Gone.md#part)", "does not exist"),
    ("[dead](a.md#three-words)", "no heading"),
    ("[dead](a.md#two-words-2)", "no heading"),
    ("[dead](#two-words)", "no heading"),
    ("[dead](p.png#part)", "no Markdown page"),
    ("[dead](/docs/a.md)", "not relative"),
    ("[dead](../../a.md)", "out of the repository"),
    ("[dead](../build/generated.md)", "generated"),
    ("[dead]()", "names nothing"),
    ("- item\n  [dead](gone.md)", "does not exist"),
    ("- item\n\n  [dead](gone.md)", "does not exist"),
    ("text\n    [dead](gone.md)", "does not exist"),
    ("| [dead](gone.md) |\n|---|", "does not exist"),
    ("[ref]\n\n[ref]: gone.md", "does not exist"),
    ("<a href=\"gone.md\">dead</a>", "does not exist"),
    ("a `stray mark, [dead](gone.md)", "does not exist"),
]


def write(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


class CheckLinks(unittest.TestCase):
    def dead_links(self, files):
        with tempfile.TemporaryDirectory() as folder:
            write(pathlib.Path(folder), files)
            return list(check_links.dead_links(folder))

    def test_links_that_work_pass(self):
        self.assertEqual(self.dead_links(CORRECT), [])

    def test_every_planted_dead_link_is_seen_alone_and_in_its_place(self):
        for text, complaint in PLANTED:
            with self.subTest(text=text):
                found = self.dead_links(CORRECT | {"docs/bad.md": f"# Bad\n\n{text}\n"})
                self.assertEqual(len(found), 1, found)
                self.assertEqual(found[0][0], pathlib.Path("docs/bad.md"))
                self.assertEqual(f"# Bad\n\n{text}".split("\n")[found[0][1] - 1].count(found[0][2]) > 0, True)
                self.assertIn(complaint, found[0][3])

    def test_the_program_fails_when_a_link_is_dead(self):
        for extra, code in (({}, 0), ({"docs/bad.md": "[dead](gone.md)\n"}, 1)):
            with tempfile.TemporaryDirectory() as folder:
                write(pathlib.Path(folder), CORRECT | extra)
                done = subprocess.run([sys.executable, check_links.__file__, folder], capture_output=True, text=True)
                self.assertEqual(done.returncode, code, done.stdout)
                self.assertEqual("docs/bad.md:1: gone.md does not exist" in done.stdout, code == 1)


class Headings(unittest.TestCase):
    def test_anchors_are_those_of_github(self):
        for heading, anchor in [("Two words", "two-words"), ("4b. The model fluid", "4b-the-model-fluid"),
                                ("At Re_tau = 180", "at-re_tau--180"), ("`collision: trt` (3/16)", "collision-trt-316"),
                                ("Drag: *how much?*", "drag-how-much"), ("[a link](b.md) here", "a-link-here"),
                                ("q* and tau*", "q-and-tau"), ("Grüße", "grüße")]:
            self.assertEqual(markdown_text.slug(heading), anchor)

    def test_code_has_no_headings(self):
        self.assertEqual(markdown_text.anchors("# A\n\n```sh\n# b\n```\n\n    # c\n"), {"a"})


if __name__ == "__main__":
    unittest.main()
