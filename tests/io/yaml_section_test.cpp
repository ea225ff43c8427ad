// One description of the keys: read, written, documented; and every complaint as one sentence that says where.
#include "core/base/error.hpp"
#include "io/text/section_reader.hpp"
#include "io/text/section_writer.hpp"
#include "tests/io/scratch_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

namespace thalweg::io::yaml_section_test {

enum class Colour { red, green };

struct Wheel {
  double radius = 0.0;
  std::optional<Vec3> axis;
  bool operator==(const Wheel&) const = default;
};
struct Paint {
  Colour colour = Colour::red;
  double gloss = 0.5;
  bool operator==(const Paint&) const = default;
};
struct Cargo {
  std::optional<double> mass;
  bool operator==(const Cargo&) const = default;
};
struct Cart {
  std::string name = "cart";
  double length = 0.0;
  Vec3 position = Vec3::Zero();
  std::int64_t seats = 2;
  bool brake = false;
  Paint paint;
  std::optional<Paint> lining;
  Cargo cargo;
  std::vector<Wheel> wheels;
  std::vector<Vec3> track;
  std::vector<Colour> flags{Colour::green};
  std::optional<std::int64_t> doors;
  std::vector<Colour> stripes;  // empty: none given
  bool operator==(const Cart&) const = default;
};

const std::vector<NamedChoice<Colour>> colours{{Colour::red, "red"}, {Colour::green, "green"}};

static void describe(SectionVisitor& visit, Wheel& wheel) {
  visit.real("radius", wheel.radius, {.unit = "m", .meaning = "outer", .required = true, .above = 0.0, .example = 0.3});
  visit.vec3("axis", wheel.axis, {.meaning = "of turning"});
}
static void describe(SectionVisitor& visit, Paint& paint) {
  visit.choice("colour", paint.colour, colours,
               {.meaning = "seen in daylight", .required = true, .removed = {{"scarlet", "take red"}}});
  if (paint.colour == Colour::green)
    visit.real("gloss", paint.gloss, {.meaning = "shine", .at_least = 0.0, .at_most = 1.0});
  else
    visit.not_here("gloss", "only green paint shines; remove the key");
}
// A choice, and a key of one of its words alone.
struct Lamp {
  Colour colour = Colour::red;
  double range = 30.0;
};
static void describe(SectionVisitor& visit, Lamp& lamp) {
  visit.choice("colour", lamp.colour, colours, {.meaning = "at night"});
  visit.real("range", lamp.range,
             {.unit = "m",
              .meaning = "of sight",
              .only_if = {lamp.colour == Colour::green, "only a green lamp has one; remove it", "colour: green"}});
}
struct LampPost {
  Lamp upper, lower{Colour::green, 20.0};
};
static void describe(SectionVisitor& visit, LampPost& post) {
  visit.section("upper", post.upper, {.meaning = "on top", .shorthand = "colour"});
  visit.section("lower", post.lower, {.meaning = "at hand", .shorthand = "colour"});
}
static void describe(SectionVisitor& visit, Cargo& cargo) {
  visit.real("mass", cargo.mass, {.unit = "kg", .meaning = "of the load", .above = 0.0});
}
static void describe(SectionVisitor& visit, Cart& cart) {
  visit.text("name", cart.name, {.meaning = "painted on the side"});
  visit.real("length", cart.length,
             {.unit = "m", .meaning = "overall", .required = true, .above = 0.0, .example = 2.0});
  visit.vec3("position", cart.position, {.unit = "m", .meaning = "of the centre", .at_least = 0.0});
  visit.integer("seats", cart.seats, {.meaning = "for people", .at_least = 1});
  visit.flag("brake", cart.brake, {.meaning = "has one"});
  visit.section("paint", cart.paint, {.meaning = "outside", .shorthand = "colour"});
  visit.section("lining", cart.lining, {.meaning = "inside", .shorthand = "colour"});
  visit.section("cargo", cart.cargo, {.meaning = "load", .empty_name = "none"});
  visit.list("wheels", cart.wheels, {.meaning = "all of them"});
  visit.vec3_list("track", cart.track, {.unit = "m", .meaning = "way points"});
  visit.choice_list("flags", cart.flags, colours, {.meaning = "flown"});
  visit.integer("doors", cart.doors, {.meaning = "on both sides", .at_least = 1});
  visit.choice_list("stripes", cart.stripes, colours, {.meaning = "from the front"});
  visit.require(cart.seats < 10 || cart.length > 5.0, "seats", "a short cart has fewer than 10");
}

namespace {

using testing::message_of;
using testing::ScratchFolder;

Cart read(const std::string& yaml, const std::vector<std::string>& overrides = {}) {
  const ScratchFolder folder;
  testing::put(folder / "cart.yaml", yaml);
  const YamlDocument document(folder / "cart.yaml", overrides);
  Cart cart;
  read_document(document, cart);
  return cart;
}

const std::string minimal = "paint: red\nlength: 2.5\n";

Cart full_cart() {
  Cart cart;
  cart.name = "a \"quoted\" name: # \\ \xc3\xa4 \x7f\x1b \xc2\x80\xc2\x9f\xc2\xa0\xef\xbf\xbe";
  cart.length = 1.0 / 3.0;
  cart.position = {0.1 + 0.2, 1e-300, 3.0};
  cart.seats = 5;
  cart.brake = true;
  cart.paint = {Colour::green, 0.7};
  cart.lining = Paint{};
  cart.cargo.mass = 12.5;
  cart.wheels = {{0.3, std::nullopt}, {0.4, Vec3(0, 1, 0)}};
  cart.track = {{1, 2, 3}, {-4, 5e-5, 6}};
  cart.flags = {Colour::red, Colour::green};
  cart.doors = 4;
  cart.stripes = {Colour::green};
  return cart;
}

TEST(YamlSection, FillsInDefaults) {
  const Cart cart = read(minimal);
  EXPECT_EQ(cart.length, 2.5);
  EXPECT_EQ(cart.name, "cart");
  EXPECT_EQ(cart.seats, 2);
  EXPECT_FALSE(cart.lining.has_value());
  EXPECT_EQ(cart.flags, std::vector<Colour>{Colour::green});
  EXPECT_FALSE(cart.doors.has_value());
  EXPECT_TRUE(cart.stripes.empty());
}

TEST(YamlSection, WhatIsWrittenReadsBackTheSame) {
  for (const YamlStyle style : {YamlStyle::plain, YamlStyle::documented}) {
    EXPECT_EQ(read(written(full_cart(), style)), full_cart()) << written(full_cart(), style);
    const Cart small = read(minimal);
    EXPECT_EQ(read(written(small, style)), small) << written(small, style);
  }
}

TEST(YamlSection, DocumentationShowsUnitRangeMeaningAndWhatIsNotGiven) {
  const std::string text = written(read(minimal), YamlStyle::documented);
  for (const std::string part : {"length: 2.5   ", "# example, required, m, above 0; overall\n", "paint: red   ",
                                 "cargo: none   ", "# mass: 1   ", "# lining: red   ", "# red | green; flown\n",
                                 "# doors: 1   ", "# whole number, at least 1; on both sides\n", "# stripes: [red]   "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(YamlSection, DocumentationShowsTheKeysOfOtherChoicesAsComments) {
  const std::string text = written(Lamp{}, YamlStyle::documented);
  EXPECT_NE(text.find("\n# range: 30   "), std::string::npos) << text;
  EXPECT_NE(text.find("# m; of sight; only with colour: green\n"), std::string::npos) << text;
  EXPECT_EQ(written(Lamp{}, YamlStyle::plain), "colour: red\n");
  EXPECT_EQ(written(Lamp{Colour::green, 20.0}, YamlStyle::documented).find("only with"), std::string::npos);
  // A section that a word stands for stays that word.
  const std::string post = written(LampPost{}, YamlStyle::documented);
  EXPECT_NE(post.find("upper: red   "), std::string::npos) << post;
  EXPECT_NE(post.find("lower:   "), std::string::npos) << post;
}

TEST(YamlSection, OverridesReplaceAddReachIntoListsAndRemove) {
  const std::string yaml = minimal + "seats: 3\nwheels:\n  - radius: 0.1\n  - {radius: 0.2}\n";
  const Cart cart = read(yaml, {"length=7", "wheels.1.radius=0.9", "cargo.mass=3", "position=[1, 2, 3]", "seats=null",
                                "length=8", "lining={colour: green, gloss: 0.25}"});
  EXPECT_EQ(cart.length, 8.0);  // the last one counts
  EXPECT_EQ(cart.wheels[0].radius, 0.1);
  EXPECT_EQ(cart.wheels[1].radius, 0.9);
  EXPECT_EQ(cart.cargo.mass, 3.0);
  EXPECT_EQ(cart.position, Vec3(1, 2, 3));
  EXPECT_EQ(cart.seats, 2);
  EXPECT_EQ(cart.lining->gloss, 0.25);
}

TEST(YamlSection, WhatIsNotThereCanBeTakenOutAndBringsNoSectionIntoBeing) {
  EXPECT_EQ(read(minimal, {"lining.gloss=null", "cargo.mass=null", "name=null"}), read(minimal));
  EXPECT_FALSE(read(minimal, {"lining.gloss=null"}).lining.has_value());
  const Cart lined = read(minimal + "lining: {colour: green, gloss: 0.25}\n", {"lining.gloss=null"});
  EXPECT_EQ(lined.lining, (Paint{Colour::green, Paint{}.gloss}));
}

struct Bad {
  std::string name, yaml, override_text, message;  // FILE stands for the path
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadYaml : public ::testing::TestWithParam<Bad> {};

TEST_P(BadYaml, IsOneSentenceThatSaysWhere) {
  std::vector<std::string> overrides;
  if (!GetParam().override_text.empty()) overrides.push_back(GetParam().override_text);
  std::string path;
  const std::string message = message_of<InputError>([&] {
    const ScratchFolder folder;
    path = (folder / "cart.yaml").string();
    testing::put(path, GetParam().yaml);
    const YamlDocument document(path, overrides);
    Cart cart;
    read_document(document, cart);
  });
  std::string expected = GetParam().message;
  for (std::size_t at = expected.find("FILE"); at != std::string::npos; at = expected.find("FILE"))
    expected.replace(at, 4, path);
  EXPECT_EQ(message, expected);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadYaml,
    ::testing::Values(
        Bad{"text_for_number", "paint: red\nlength: long\n", "",
            "FILE:2: length = \"long\": expected a number in m above 0, for example 2."},
        Bad{"decimal_comma", "paint: red\nlength: 2\ncargo: {mass: 9,81}\n", "",
            "FILE:3: cargo.81 = \"\": a comma begins a new key here; write numbers with a point, as 9.81."},
        Bad{"colon_without_space", "paint: red\nlength: 2\ncargo: {mass:9}\n", "",
            "FILE:3: cargo.mass:9 = \"\": write a space after the colon: mass: 9."},
        Bad{"number_with_unit", "paint: red\nlength: 2 m\n", "",
            "FILE:2: length = \"2 m\": expected a number in m above 0, for example 2."},
        Bad{"not_finite", "paint: red\nlength: .inf\n", "",
            "FILE:2: length = \".inf\": expected a number in m above 0, for example 2."},
        Bad{"out_of_range", "paint: red\nlength: -1\n", "",
            "FILE:2: length = -1: expected a number in m above 0, for example 2."},
        Bad{"section_for_number", "paint: red\nlength: {a: 1}\n", "",
            "FILE:2: length = a section with 1 key: expected a number in m above 0, for example 2."},
        Bad{"missing", "# nothing\npaint: red\n", "",
            "FILE:1: length is missing: give a number in m above 0, for example 2."},
        Bad{"missing_in_list", "paint: red\nlength: 2\nwheels:\n  - radius: 1\n  - axis: [1, 0, 0]\n", "",
            "FILE:5: wheels.1.radius is missing: give a number in m above 0, for example 0.3."},
        Bad{"unknown", "paint: red\nlenght: 2\n", "", "FILE:2: lenght = 2: unknown key; did you mean length?"},
        Bad{"unknown_far", "paint: red\nlength: 2\ncargo:\n  horse: 1\n", "",
            "FILE:4: cargo.horse = 1: unknown key; cargo has the keys mass."},
        Bad{"duplicate", "paint: red\nlength: 2\nseats: 3\nlength: 3\n", "",
            "FILE:4: length: the key is given twice (first at FILE:2); remove one of the two."},
        Bad{"fraction_for_integer", minimal + "seats: 2.5\n", "",
            "FILE:3: seats = 2.5: expected a whole number, at least 1, for example 2."},
        Bad{"negative_optional_integer", minimal + "doors: -2\n", "",
            "FILE:3: doors = -2: expected a whole number, at least 1, for example 1."},
        Bad{"no_words", minimal + "stripes: []\n", "",
            "FILE:3: stripes = []: expected a list of some of red, green, for example [red]."},
        Bad{"flag", minimal + "brake: maybe\n", "", "FILE:3: brake = \"maybe\": expected true or false."},
        Bad{"short_vector", minimal + "position: [1, 2]\n", "",
            "FILE:3: position = [1, 2]: expected a list of 3 numbers in m, each at least 0, for example [0.1, 0.1, "
            "0.1]."},
        Bad{"vector_of_text", minimal + "position: [1, 2, x]\n", "",
            "FILE:3: position = [1, 2, \"x\"]: expected a list of 3 numbers in m, each at least 0, for example "
            "[0.1, 0.1, 0.1]."},
        Bad{"choice", "length: 2\npaint:\n  colour: blue\n", "",
            "FILE:3: paint.colour = \"blue\": expected one of red, green."},
        Bad{"removed_word", "length: 2\npaint:\n  colour: scarlet\n", "",
            "FILE:3: paint.colour = \"scarlet\": take red."},
        Bad{"choice_in_list", minimal + "flags: [red, blue]\n", "",
            "FILE:3: flags.1 = \"blue\": expected one of red, green."},
        Bad{"twice_in_list", minimal + "flags: [red, red]\n", "",
            "FILE:3: flags.1 = \"red\": the word is given twice; remove one of the two."},
        Bad{"not_here", "length: 2\npaint: {colour: red, gloss: 0.1}\n", "",
            "FILE:2: paint.gloss = 0.1: only green paint shines; remove the key."},
        Bad{"scalar_for_section", minimal + "cargo: 12\n", "",
            "FILE:3: cargo = 12: expected none or a section of keys with values."},
        Bad{"list_for_section", minimal + "cargo: [12]\n", "",
            "FILE:3: cargo = [12]: expected a section of keys with values, not a list."},
        Bad{"section_for_list", minimal + "wheels: {radius: 1}\n", "",
            "FILE:3: wheels = a section with 1 key: expected a list of sections, each beginning with a dash."},
        Bad{"condition", minimal + "seats: 12\n", "", "FILE:3: seats = 12: a short cart has fewer than 10."},
        Bad{"override_value", minimal, "length=far",
            "--set length=far: length = \"far\": expected a number in m above 0, for example 2."},
        Bad{"override_unknown", minimal, "cargo.maas=1",
            "--set cargo.maas=1: cargo.maas = 1: unknown key; did you mean cargo.mass?"},
        Bad{"override_takes_out_unknown", minimal, "cargo.maas=null",
            "--set cargo.maas=null: cargo.maas: unknown key; did you mean cargo.mass?"},
        Bad{"override_takes_out_of_unknown", minimal, "linning.gloss=null",
            "--set linning.gloss=null: linning: unknown key; did you mean lining?"},
        Bad{"override_without_value", minimal, "length",
            "--set length: expected KEY=VALUE, for example --set run.until=10."},
        Bad{"override_index", minimal + "wheels: [{radius: 1}]\n", "wheels.1.radius=2",
            "--set wheels.1.radius=2: wheels is a list of 1 and has no entry \"1\"; count from 0."},
        Bad{"override_takes_out_item", minimal + "wheels: [{radius: 1}]\n", "wheels.0=null",
            "--set wheels.0=null: an entry of a list cannot be removed; set all of wheels, or remove all of it."},
        Bad{"override_into_scalar", minimal, "length.x=2",
            "--set length.x=2: length = 2.5 is a single value and has no key x; set length itself."},
        Bad{"second_document", minimal + "---\n# nothing\nnonsense: 1\n", "",
            "FILE:5: a second document begins here, after a line ---, and would be ignored; remove that line, or what "
            "follows it."},
        Bad{"latin_1", minimal + "name: caf\xE9\n", "",
            "FILE:3: the byte 0xe9 here is not UTF-8; save the text as UTF-8."},
        Bad{"latin_1_in_an_override", minimal, "name=caf\xE9",
            "--set name=caf\xE9: the byte 0xe9 here is not UTF-8; save the text as UTF-8."},
        Bad{"end_of_transmission", minimal + "seats: 3\n\x04\nseats: nonsense\n", "",
            "FILE:4: a control character, 0x04, stands here; remove it, or save the file as text."},
        Bad{"utf_8_in_utf_8", minimal + "name: d\xC3\xA2\xC2\x80\xC2\x99\n", "",
            "FILE:3: a control character, 0x80, stands here; remove it, or save the file as text."},
        Bad{"no_character", minimal + "name: a\xEF\xBF\xBF\n", "",
            "FILE:3: a control character, 0xffff, stands here; remove it, or save the file as text."},
        Bad{"zero", minimal + std::string("name: a\0b\n", 10), "",
            "FILE:3: a control character, 0x00, stands here; remove it, or save the file as text."},
        Bad{"escaped_zero", minimal + "name: \"a\\0b\"\n", "", "FILE:3: name: a text must not have a zero character."},
        Bad{"old_macintosh", "paint: red\rlength: 2\r", "",
            "FILE:1: a carriage return without a line feed stands here or below; save the text with the line ends of "
            "Unix or Windows."},
        Bad{"tab", "paint: red\nplaces:\n \tseats: 3\n", "",
            "FILE:3: this line is indented with a tab, which YAML does not allow; use spaces."},
        Bad{"no_sections_at_all", "just words\n", "",
            "FILE:1: expected keys with values, for example system: resolved."}),
    [](const auto& bad) { return bad.param.name; });

TEST(YamlSection, SyntaxErrorsHaveALine) {
  const std::string message = message_of<InputError>([] { read("paint: red\nlength: [1, 2\nseats: 3\n"); });
  EXPECT_NE(message.find("cart.yaml:3: this is not valid YAML: "), std::string::npos) << message;
}

TEST(YamlSection, ADocumentMayBeMarkedAsOne) {
  for (const std::string& text : {"---\n" + minimal, "# words\n---\n" + minimal + "...\n", minimal + "---\n"})
    EXPECT_EQ(read(text).length, 2.5) << text;
}

TEST(YamlSection, LineEndsOfWindowsAndAByteOrderMarkMeanNothing) {
  EXPECT_EQ(read("\xEF\xBB\xBFpaint: red\r\nlength: 2.5\r\n").length, 2.5);
}

// A hundred thousand keys are compared with each other in less than 1e10 steps.
TEST(YamlSection, ManyKeysAreLookedThroughQuickly) {
  std::string text;
  for (int n = 0; n < 100000; ++n) text += fmt::format("key_{}: 1\n", n);
  const auto begin = std::chrono::steady_clock::now();
  const std::string message = message_of<InputError>([&] { read(text + "key_7: 1\n"); });
  EXPECT_NE(message.find(":100001: key_7: the key is given twice"), std::string::npos) << message;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

// Seven levels of ten aliases each: 330 bytes that stand for ten million values.
TEST(YamlSection, AliasesThatMultiplyAreRefused) {
  std::string text = minimal + "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int level = 1; level < 7; ++level) {
    text += fmt::format("a{0}: &a{0} [", level);
    for (int n = 0; n < 10; ++n) text += fmt::format("{}*a{}", n ? ", " : "", level - 1);
    text += "]\n";
  }
  const std::string message = message_of<InputError>([&] { read(text); });
  EXPECT_NE(message.find("with its aliases (*name) the file has more than 1000000 values; write out what is meant."),
            std::string::npos)
      << message;
  EXPECT_EQ(read(minimal + "wheels: [&w {radius: 1}, *w, *w]\n").wheels.size(), 3u);
}

TEST(YamlSection, MissingFilesAndFolders) {
  EXPECT_EQ(message_of<InputError>([] { YamlDocument("nowhere/case.yaml", {}); }),
            "nowhere/case.yaml: there is no such file; check the path.");
  const ScratchFolder folder;
  EXPECT_NE(
      message_of<InputError>([&] { YamlDocument(folder.path(), {}); }).find("this is a folder: give the case file"),
      std::string::npos);
  std::filesystem::create_symlink("loop.yaml", folder / "loop.yaml");
  EXPECT_NE(message_of<InputError>([&] {
              YamlDocument(folder / "loop.yaml", {});
            }).find("loop.yaml: cannot read the file: Too many levels of symbolic links."),
            std::string::npos);
}

}  // namespace
}  // namespace thalweg::io::yaml_section_test
