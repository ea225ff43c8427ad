"""What scripts/docs makes of the pages before mkdocs reads them, and the page of keys, on made-up pages and keys."""
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs/site"))
import doxygen_comments
import keys
import stage

PRINTED = {
    "resolved": """# Every key of a case with system: resolved, with its default.
system: resolved                            # example, required, resolved (with grains) | fluid (alone); what is simulated
fluid:                                      # properties of the fluid
  collision: bgk                            # bgk (one; time) | trt; collision operator
  # magic_parameter: 0.1875                 # 1, above 0; of trt; only with collision: trt
  # mean_velocity:                          # maintain this; by a force
    # velocity: 0.3                         # required, m/s; mean over the fluid
grains:                                     # populations of grains
  - placement:                              # where the grains are
      seed: 1                               # whole number, at least 0; of the placement
    # shape:                                # no spheres
      # clump: []                           # spheres
        # - position: [0, 0, 0]             # required, m; any origin
          # diameter: 0.004                 # required, m, above 0; of the sphere
    density: 2550                           # example, required, kg/m^3, above 0; of every grain
run:                                        # duration
  until: 3                                  # example, required, s, above 0; end
""",
    "fluid": """system: fluid   # example, required, resolved (with grains) | fluid (alone); what is simulated
fluid:                                      # properties of the fluid
  collision: trt                            # bgk (one; time) | trt; collision operator
  extra: 0                                  # 1; more
run:                                        # duration
  until: 5                                  # example, required, s, above 0; end
""",
}


class Keys(unittest.TestCase):
    def test_paths_follow_sections_and_lists(self):
        self.assertEqual([key.path for key in keys.read_keys(PRINTED["resolved"])],
                         ["system", "fluid", "fluid.collision", "fluid.magic_parameter", "fluid.mean_velocity",
                          "fluid.mean_velocity.velocity", "grains", "grains[].placement", "grains[].placement.seed",
                          "grains[].shape", "grains[].shape.clump", "grains[].shape.clump[].position",
                          "grains[].shape.clump[].diameter", "grains[].density", "run", "run.until"])

    def test_comments_are_taken_apart(self):
        by_path = {key.path: key for key in keys.read_keys(PRINTED["resolved"])}
        collision, magic = by_path["fluid.collision"], by_path["fluid.magic_parameter"]
        self.assertEqual((collision.kind, collision.meaning), ("bgk (one; time) | trt", "collision operator"))
        self.assertTrue(collision.has_default)
        self.assertEqual((magic.kind, magic.meaning, magic.only_with), ("1, above 0", "of trt", "collision: trt"))
        self.assertEqual(by_path["fluid.mean_velocity"].meaning, "maintain this; by a force")
        self.assertTrue(by_path["grains[].density"].required and by_path["grains[].density"].example)

    def test_each_key_has_one_entry_in_its_section_and_an_anchor(self):
        page = keys.page(PRINTED)
        self.assertEqual(page.count("{#fluid.collision}"), 1)
        self.assertIn("### grains\\[\\].density {#grains.n.density}", page)
        self.assertLess(page.index("{#fluid.extra}"), page.index("{#grains}"))
        self.assertEqual(page.count("default `bgk`"), 1)
        self.assertEqual(page.count("default `trt`"), 1)   # differs, so both are there
        self.assertEqual(page.count("example `3`"), 1)     # of examples, one is enough
        self.assertNotIn("example `5`", page)


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        for name, text in {
            "README.md": "# Start\n",
            "a/README.md": "# A\n",
            "a/b/README.md": "# B\n",
            "a/case.yaml": "", "src/main.cpp": "",
            "docs/c.md": "# C\n",
        }.items():
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            (self.root / name).write_text(text)

    def test_links_to_folders_and_missing_files_are_adapted(self):
        for text, expected in [
            ("[a](../a)", "[a](../a/README.md)"),
            ("[a](../a/#a)", "[a](../a/README.md#a)"),
            ("see [the source](../src/main.cpp).", "see the source."), ("[src](../src)", "src"),
            ("[case](../a/case.yaml)", "[case](../a/case.yaml)"), ("[w](https://a.b)", "[w](https://a.b)"),
            ("[c](#c) and [s](../README.md#start)", "[c](#c) and [s](../README.md#start)"),
            ("`[x](../src)`", "`[x](../src)`"),
        ]:
            self.assertEqual(stage.with_site_links(self.root, pathlib.Path("docs/c.md"), text), expected)

    def test_headings_have_their_anchors_and_code_is_left_alone(self):
        self.assertEqual(
            stage.with_anchors("# A b\n## A b\n\n```\n# c\n```"), "# A b {#a-b}\n## A b {#a-b-1}\n\n```\n# c\n```"
        )

    def test_lists_have_room(self):
        self.assertEqual(stage.with_wide_lists("text\n- one\n  more\n- two\n\n  par\n\n      code\n\nend"),
                         "text\n\n- one\n    more\n- two\n\n    par\n\n        code\n\nend")
        self.assertEqual(stage.with_wide_lists("- a\n  - b\n    c\n- d"), "- a\n    - b\n        c\n- d")
        self.assertEqual(stage.with_wide_lists("```\na\n- b\n```\n\n    x = 1\n"), "```\na\n- b\n```\n\n    x = 1\n")
        self.assertEqual(stage.with_wide_lists("1. a\n   b\n2. c"), "1. a\n    b\n2. c")

    def test_the_navigation_holds_every_page_once(self):
        pages = [pathlib.Path(name) for name in ("README.md", "a/README.md", "a/b/README.md", "docs/c.md")]
        entries = [{"Start": ["README.md"]}, {"A": ["a/*"]}, {"Docs": [{"Name": "docs/c.md"}]}]
        self.assertEqual(stage.navigation(self.root, entries, pages),
                         [{"Start": [{"Start": "README.md"}]}, {"A": [{"A": "a/README.md"}, {"B": "a/b/README.md"}]},
                          {"Docs": [{"Name": "docs/c.md"}]}])
        with self.assertRaisesRegex(ValueError, "docs/c.md"):
            stage.navigation(self.root, entries[:2], pages)

    def test_the_repository_has_a_place_for_every_page(self):
        stage.configuration(stage.ROOT, stage.markdown_text.markdown_files(stage.ROOT))


class Comments(unittest.TestCase):
    def test_comments_document_what_they_stand_before_or_behind(self):
        lines = [
            "// One.", "struct A {", "  double x;  // m", "             // or mm", "  int n;", "};  ",
            "}  // namespace a",
        ]
        self.assertEqual(
            list(doxygen_comments.documented(lines)),
            [
                "/// One.", "struct A {", "  double x;  ///< m", "             ///< or mm", "  int n;", "};  ",
                "}  // namespace a",
            ],
        )
        self.assertEqual(list(doxygen_comments.documented(["// a < b @ c"])), ["/// a \\< b \\@ c"])


if __name__ == "__main__":
    unittest.main()
