#include "io/text/section_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>

#include "io/text/section_writer.hpp"

namespace thalweg::io {
namespace {

// Reads the whole text as a number; from_chars alone refuses a leading plus.
template <typename Number>
bool parse(const std::string& text, Number& value) {
  const char* begin = text.data();
  const char* end = begin + text.size();
  if (text.size() > 1 && *begin == '+' && text[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end;
}

bool in_range(double value, const RealKey& about) {
  return std::isfinite(value) && !(about.above && !(value > *about.above)) &&
         !(about.below && !(value < *about.below)) && !(about.at_least && !(value >= *about.at_least)) &&
         !(about.at_most && !(value <= *about.at_most));
}

std::string range_of(const RealKey& about) {
  std::vector<std::string> bounds;
  if (about.above) bounds.push_back("above " + shortest(*about.above));
  if (about.at_least) bounds.push_back("at least " + shortest(*about.at_least));
  if (about.below) bounds.push_back("below " + shortest(*about.below));
  if (about.at_most) bounds.push_back("at most " + shortest(*about.at_most));
  return bounds.empty() ? "" : fmt::format(" {}", fmt::join(bounds, " and "));
}

std::string unit_of(const RealKey& about) { return about.unit == "1" ? "" : " in " + about.unit; }

// "a number in kg/m^3 above 0, for example 1000"
std::string expected_real(const RealKey& about, double fallback) {
  const double example = about.example.value_or(fallback);
  return fmt::format("a number{}{}", unit_of(about), range_of(about)) +
         (in_range(example, about) ? fmt::format(", for example {}", shortest(example)) : "");
}

std::string expected_vec3(const RealKey& about) {
  const double e = about.example.value_or(0.1);
  const std::string range = range_of(about);
  return fmt::format("a list of 3 numbers{}{}{}, for example [{}, {}, {}]", unit_of(about),
                     range.empty() ? "" : ", each", range, shortest(e), shortest(e), shortest(e));
}

// Levenshtein distance.
std::size_t edits_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

// The word most like this one; empty if none is close enough.
std::string nearest(const std::string& word, const std::vector<std::string>& words) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : words) {
    const std::size_t edits = edits_between(word, candidate);
    if (edits < least) {
      least = edits;
      best = candidate;
    }
  }
  return best;
}

// What to do about a key without a value that YAML has found where none was meant; empty if it is a key.
std::string remedy_of_notation(const std::string& key) {
  if (std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
    return "a comma begins a new key here; write numbers with a point, as 9.81";
  const std::size_t colon = key.find(':');
  if (colon == std::string::npos) return "";
  return fmt::format("write a space after the colon: {}: {}", key.substr(0, colon), key.substr(colon + 1));
}

}  // namespace

SectionReader::SectionReader(const YamlDocument& document, std::string key_path, const YamlNode& section)
    : document_(document), key_path_(std::move(key_path)), section_(section) {}

void SectionReader::fail(const YamlNode& node, const std::string& key, const std::string& remedy) const {
  const std::string name = shorthand_ && key == *shorthand_ ? key_path_ : joined_key(key_path_, key);
  throw InputError(
      fmt::format("{}: {} = {}: {}{}", node.place, name, shown(node), remedy, remedy.ends_with('?') ? "" : "."));
}

// A missing key waits until the whole document is read: most often it is there but misspelt, and the misspelling is the
// better complaint.
const YamlNode* SectionReader::look_up(const std::string& key, bool required, const std::string& expectation) {
  known_.push_back(key);
  const YamlNode* node = section_.find(key);
  if (!node && required)
    note_missing(fmt::format("{}: {} is missing: give {}.", section_.place, joined_key(key_path_, key), expectation));
  return node;
}

void SectionReader::note_missing(const std::string& complaint) {
  if (missing_.empty()) missing_ = complaint;
}

// What to do about a key that the section does not have.
std::string SectionReader::remedy_of_unknown(const std::string& key) const {
  const std::string meant = nearest(key, known_);
  if (!meant.empty()) return fmt::format("unknown key; did you mean {}?", joined_key(key_path_, meant));
  return fmt::format("unknown key; {} {}", key_path_.empty() ? "a case has" : key_path_ + " has",
                     known_.empty() ? "no keys" : fmt::format("the keys {}", fmt::join(known_, ", ")));
}

void SectionReader::refuse_unknown() const {
  const auto has = [](const std::vector<std::string>& keys, const std::string& key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  for (const auto& [key, node] : section_.entries) {
    if (has(known_, key)) continue;
    const bool has_no_value = node.kind == YamlNode::Kind::scalar && node.text.empty();
    const std::string notation = has_no_value ? remedy_of_notation(key) : "";
    fail(node, key, notation.empty() ? remedy_of_unknown(key) : notation);
  }
  // A key that is taken out under a wrong name would stay what it is.
  const std::string above = joined_key(key_path_, "");
  for (const TakenOut& taken : document_.taken_out()) {
    if (!taken.key_path.starts_with(above)) continue;
    const std::string key = taken.key_path.substr(above.size(), taken.key_path.find('.', above.size()) - above.size());
    if (has(known_, key) || has(elsewhere_, key)) continue;
    const std::string remedy = remedy_of_unknown(key);
    throw InputError(
        fmt::format("{}: {}: {}{}", taken.place, joined_key(key_path_, key), remedy, remedy.ends_with('?') ? "" : "."));
  }
}

void SectionReader::finish() const {
  refuse_unknown();
  if (!missing_.empty()) throw InputError(missing_);
}

double SectionReader::real_from(const YamlNode& node, const std::string& key, const RealKey& about,
                                const std::string& expectation) const {
  double value = 0.0;
  if (node.kind != YamlNode::Kind::scalar || !parse(node.text, value) || !in_range(value, about))
    fail(node, key, "expected " + expectation);
  return value;
}

Vec3 SectionReader::vec3_from(const YamlNode& node, const std::string& key, const RealKey& about,
                              const std::string& expectation) const {
  if (node.kind != YamlNode::Kind::list || node.items.size() != 3) fail(node, key, "expected " + expectation);
  Vec3 value;
  for (int axis = 0; axis < 3; ++axis) {
    const YamlNode& item = node.items[static_cast<std::size_t>(axis)];
    if (item.kind != YamlNode::Kind::scalar || !parse(item.text, value[axis]) || !in_range(value[axis], about))
      fail(node, key, "expected " + expectation);
  }
  return value;
}

void SectionReader::value_of(const std::string& key, double& value, const RealKey& about) {
  const std::string expectation = expected_real(about, value);
  if (const YamlNode* node = look_up(key, about.required, expectation))
    value = real_from(*node, key, about, expectation);
}

void SectionReader::value_of(const std::string& key, std::optional<double>& value, const RealKey& about) {
  const std::string expectation = expected_real(about, value.value_or(1.0));
  if (const YamlNode* node = look_up(key, about.required, expectation))
    value = real_from(*node, key, about, expectation);
}

void SectionReader::value_of(const std::string& key, Vec3& value, const RealKey& about) {
  const std::string expectation = expected_vec3(about);
  if (const YamlNode* node = look_up(key, about.required, expectation))
    value = vec3_from(*node, key, about, expectation);
}

void SectionReader::value_of(const std::string& key, std::optional<Vec3>& value, const RealKey& about) {
  const std::string expectation = expected_vec3(about);
  if (const YamlNode* node = look_up(key, about.required, expectation))
    value = vec3_from(*node, key, about, expectation);
}

void SectionReader::value_of(const std::string& key, std::vector<Vec3>& values, const RealKey& about) {
  const std::string expectation = fmt::format(
      "a list of points{}, each a list of 3 numbers, for example "
      "[[0.01, 0.01, 0.005], [0.02, 0.01, 0.005]]",
      unit_of(about));
  const YamlNode* node = look_up(key, about.required, expectation);
  if (!node) return;
  if (node->kind != YamlNode::Kind::list || node->items.empty()) fail(*node, key, "expected " + expectation);
  values.clear();
  for (std::size_t n = 0; n < node->items.size(); ++n)
    values.push_back(vec3_from(node->items[n], fmt::format("{}.{}", key, n), about, expected_vec3(about)));
}

void SectionReader::value_of(const std::string& key, std::int64_t& value, const IntegerKey& about) {
  const std::string expectation =
      fmt::format("a whole number, at least {}, for example {}{}", about.at_least,
                  about.example.value_or(std::max(value, about.at_least)), about.automatic ? ", or auto" : "");
  const YamlNode* node = look_up(key, about.required, expectation);
  if (!node) return;
  if (about.automatic && node->kind == YamlNode::Kind::scalar && node->text == "auto") {
    value = *about.automatic;
    return;
  }
  std::int64_t read = 0;
  if (node->kind != YamlNode::Kind::scalar || !parse(node->text, read) || read < about.at_least)
    fail(*node, key, "expected " + expectation);
  value = read;
}

void SectionReader::value_of(const std::string& key, std::optional<std::int64_t>& value, const IntegerKey& about) {
  std::int64_t read = about.example.value_or(about.at_least);
  value_of(key, read, about);
  if (section_.find(key)) value = read;
}

void SectionReader::value_of(const std::string& key, std::vector<std::int64_t>& values, const IntegerKey& about) {
  const std::int64_t example = about.example.value_or(std::max<std::int64_t>(1, about.at_least));
  const std::string expectation =
      fmt::format("a list of whole numbers, at least {}, for example [{}, {}]", about.at_least, example, example + 1);
  const YamlNode* node = look_up(key, about.required, expectation);
  if (!node) return;
  if (node->kind != YamlNode::Kind::list || node->items.empty()) fail(*node, key, "expected " + expectation);
  values.clear();
  for (std::size_t n = 0; n < node->items.size(); ++n) {
    const YamlNode& item = node->items[n];
    std::int64_t read = 0;
    if (item.kind != YamlNode::Kind::scalar || !parse(item.text, read) || read < about.at_least)
      fail(item, fmt::format("{}.{}", key, n), fmt::format("expected a whole number, at least {}", about.at_least));
    values.push_back(read);
  }
}

void SectionReader::value_of(const std::string& key, std::vector<double>& values, const RealKey& about) {
  const double example = about.examples.empty() ? about.example.value_or(1.0) : about.examples.front();
  std::vector<std::string> examples;
  for (const double each : about.examples) examples.push_back(shortest(each));
  if (examples.empty()) examples.assign(2, shortest(example));
  const std::string expectation = fmt::format("a list of numbers{}{}, for example [{}]", unit_of(about),
                                              range_of(about), fmt::join(examples, ", "));
  const YamlNode* node = look_up(key, about.required, expectation);
  if (!node) return;
  if (node->kind != YamlNode::Kind::list || node->items.empty()) fail(*node, key, "expected " + expectation);
  values.clear();
  for (std::size_t n = 0; n < node->items.size(); ++n)
    values.push_back(real_from(node->items[n], fmt::format("{}.{}", key, n), about, expected_real(about, example)));
}

void SectionReader::value_of(const std::string& key, std::optional<std::string>& value, const TextKey& about) {
  if (!section_.find(key)) {
    look_up(key, about.required, "a text");
    return;
  }
  std::string read;
  value_of(key, read, about);
  value = read;
}

void SectionReader::value_of(const std::string& key, std::string& value, const TextKey& about) {
  const YamlNode* node = look_up(key, about.required, "a text");
  if (!node) return;
  if (node->kind != YamlNode::Kind::scalar) fail(*node, key, "expected a text");
  value = node->text;
}

void SectionReader::value_of(const std::string& key, bool& value, const TextKey& about) {
  const YamlNode* node = look_up(key, about.required, "true or false");
  if (!node) return;
  if (node->kind != YamlNode::Kind::scalar || (node->text != "true" && node->text != "false"))
    fail(*node, key, "expected true or false");
  value = node->text == "true";
}

std::size_t SectionReader::word_from(const YamlNode& node, const std::string& key, const std::vector<Word>& words,
                                     const SectionKey& about) const {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < words.size(); ++n) {
    if (node.kind == YamlNode::Kind::scalar && node.text == words[n].name) return n;
    names.push_back(words[n].name);
  }
  for (const RemovedWord& removed : about.removed)
    if (node.kind == YamlNode::Kind::scalar && node.text == removed.word) fail(node, key, removed.remedy);
  fail(node, key, fmt::format("expected {}{}", names.size() == 1 ? "" : "one of ", fmt::join(names, ", ")));
}

void SectionReader::word(const std::string& key, std::size_t& index, const std::vector<Word>& words,
                         const SectionKey& about) {
  std::vector<std::string> names;
  for (const Word& word : words) names.push_back(word.name);
  if (const YamlNode* node = look_up(key, about.required, fmt::format("one of {}", fmt::join(names, ", "))))
    index = word_from(*node, key, words, about);
}

void SectionReader::word(const std::string& key, std::optional<std::size_t>& index, const std::vector<Word>& words,
                         const SectionKey& about) {
  std::size_t read = 0;
  word(key, read, words, about);
  if (section_.find(key)) index = read;
}

void SectionReader::word_list(const std::string& key, std::vector<std::size_t>& indices, const std::vector<Word>& words,
                              const SectionKey& about) {
  std::vector<std::string> names;
  for (const Word& word : words) names.push_back(word.name);
  const std::string expectation =
      fmt::format("a list of some of {}, for example [{}]", fmt::join(names, ", "), names[0]);
  const YamlNode* node = look_up(key, about.required, expectation);
  if (!node) return;
  if (node->kind != YamlNode::Kind::list || node->items.empty()) fail(*node, key, "expected " + expectation);
  indices.clear();
  for (std::size_t n = 0; n < node->items.size(); ++n) {
    const std::string item_key = fmt::format("{}.{}", key, n);
    const std::size_t index = word_from(node->items[n], item_key, words, about);
    if (std::find(indices.begin(), indices.end(), index) != indices.end())
      fail(node->items[n], item_key, "the word is given twice; remove one of the two");
    indices.push_back(index);
  }
}

void SectionReader::not_here(const std::string& key, const std::string& reason) {
  const YamlNode* node = section_.find(key);
  if (node && missing_.empty()) fail(*node, key, reason);
  (node ? known_ : elsewhere_).push_back(key);  // what is missing may be why it is here
}

void SectionReader::require(bool condition, const std::string& key, const std::string& remedy) {
  if (condition || !missing_.empty()) return;
  if (const YamlNode* node = section_.find(key)) fail(*node, key, remedy);
  note_missing(fmt::format("{}: {}: {}.", section_.place, joined_key(key_path_, key), remedy));
}

bool SectionReader::is_given(const std::string& key, bool) { return section_.find(key) != nullptr; }

void SectionReader::read_inside(const YamlNode& node, const std::string& key, const SectionKey& about,
                                const Body& body) {
  YamlNode inside = node;
  if (node.kind == YamlNode::Kind::scalar) {
    inside.kind = YamlNode::Kind::section;
    if (!node.text.empty() && node.text != about.empty_name) {
      if (about.shorthand.empty()) {
        const std::string word = about.empty_name.empty() ? "" : fmt::format("{} or ", about.empty_name);
        fail(node, key, fmt::format("expected {}a section of keys with values", word));
      }
      inside.entries.push_back({about.shorthand, node});
    }
  }
  if (inside.kind != YamlNode::Kind::section) fail(node, key, "expected a section of keys with values, not a list");
  SectionReader reader(document_, joined_key(key_path_, key), inside);
  if (node.kind == YamlNode::Kind::scalar && !about.expected.empty()) reader.shorthand_ = about.shorthand;
  body(reader);
  reader.refuse_unknown();
  note_missing(reader.missing_);
}

void SectionReader::nested(const std::string& key, bool given, const SectionKey& about, const Body& body) {
  const YamlNode* node =
      look_up(key, about.required, about.expected.empty() ? "a section: " + about.meaning : about.expected);
  if (node) return read_inside(*node, key, about, body);
  if (!given || about.required) return;
  YamlNode empty;
  empty.place = section_.place;
  read_inside(empty, key, about, body);
}

std::size_t SectionReader::begin_list(const std::string& key, std::size_t size, const SectionKey& about) {
  const YamlNode* node = look_up(key, about.required, "a list: " + about.meaning);
  if (!node) return size;
  if (node->kind != YamlNode::Kind::list) fail(*node, key, "expected a list of sections, each beginning with a dash");
  return node->items.size();
}

void SectionReader::item(const std::string& key, std::size_t index, const Body& body) {
  const YamlNode* node = section_.find(key);
  if (node) read_inside(node->items[index], fmt::format("{}.{}", key, index), {}, body);
}

}  // namespace thalweg::io
