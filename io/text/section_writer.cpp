#include "io/text/section_writer.hpp"

#include "core/base/utf8.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <string_view>
#include <utility>

namespace thalweg::io {
namespace {

constexpr std::size_t comment_column = 44, last_column = 110;

}  // namespace

std::string yaml_text(const std::string& text) {
  std::string result = "\"";
  for (std::string_view rest = text; !rest.empty(); rest.remove_prefix(1)) {
    if (rest[0] == '"' || rest[0] == '\\') {
      result += fmt::format("\\{}", rest[0]);
    } else if (const auto code = control_character(rest)) {  // which the reader refuses
      result += *code < 0x100 ? fmt::format("\\x{:02x}", *code) : fmt::format("\\u{:04x}", *code);
      rest.remove_prefix(*code < 0x80 ? 0 : *code < 0x100 ? 1 : 2);
    } else {
      result += rest[0];
    }
  }
  return result + "\"";
}

namespace {

std::string bracketed(const Vec3& value) {
  return fmt::format("[{}, {}, {}]", shortest(value[0]), shortest(value[1]), shortest(value[2]));
}

}  // namespace

std::string shortest(double value) { return fmt::format("{}", value); }

std::string SectionWriter::comment_of(const RealKey& about) const {
  if (style_ == YamlStyle::plain) return about.unit == "1" ? "" : about.unit;
  std::string range;
  if (about.above) range += ", above " + shortest(*about.above);
  if (about.at_least) range += ", at least " + shortest(*about.at_least);
  if (about.below) range += ", below " + shortest(*about.below);
  if (about.at_most) range += ", at most " + shortest(*about.at_most);
  return fmt::format("{}{}{}; {}", about.required ? "required, " : "", about.unit, range, about.meaning);
}

void SectionWriter::put(bool given, const std::string& key, const std::string& value, const std::string& comment,
                        Source source) {
  const std::string only_with = std::exchange(only_with_, {});
  given = given && given_ && only_with.empty();
  if (!given && style_ == YamlStyle::plain) return;
  const bool example = given && source == Source::example && style_ == YamlStyle::documented;
  lines_.push_back({given, item_begins_, depth_, key, value,
                    (example ? "example, " : "") + comment + (only_with.empty() ? "" : "; only with " + only_with)});
  lines_.back().other_choice = !only_with.empty();
  item_begins_ = false;
}

bool SectionWriter::shows_key_with(const std::string& choice) {
  if (style_ == YamlStyle::plain) return false;
  only_with_ = choice;
  return true;
}

void SectionWriter::value_of(const std::string& key, double& value, const RealKey& about) {
  put(true, key, shortest(value_shown() ? value : about.example.value_or(value)), comment_of(about),
      source_of(about.required));
}

void SectionWriter::value_of(const std::string& key, std::optional<double>& value, const RealKey& about) {
  put(value.has_value(), key, shortest(value.value_or(about.example.value_or(1.0))), comment_of(about),
      Source::example);
}

void SectionWriter::value_of(const std::string& key, Vec3& value, const RealKey& about) {
  const bool show_example = !value_shown() && about.example;
  put(true, key, bracketed(show_example ? Vec3(Vec3::Constant(*about.example)) : value), comment_of(about),
      source_of(about.required));
}

void SectionWriter::value_of(const std::string& key, std::optional<Vec3>& value, const RealKey& about) {
  put(value.has_value(), key, bracketed(value.value_or(Vec3::Constant(about.example.value_or(0.0)))), comment_of(about),
      Source::example);
}

void SectionWriter::value_of(const std::string& key, std::vector<Vec3>& values, const RealKey& about) {
  if (values.empty()) return put(false, key, "[[0.01, 0.01, 0.005], [0.02, 0.01, 0.005]]", comment_of(about));
  put(true, key, "", comment_of(about));
  ++depth_;
  for (const Vec3& value : values) {
    item_begins_ = true;
    put(true, "", bracketed(value), "");
  }
  --depth_;
}

void SectionWriter::value_of(const std::string& key, std::int64_t& value, const IntegerKey& about) {
  const std::string range =
      fmt::format("whole number, at least {}{}", about.at_least, about.automatic ? ", or auto" : "");
  put(true, key, about.automatic == value ? "auto" : fmt::format("{}", value),
      style_ == YamlStyle::plain ? "" : range + "; " + about.meaning,
      source_of(about.required || about.example.has_value()));
}

void SectionWriter::value_of(const std::string& key, std::optional<std::int64_t>& value, const IntegerKey& about) {
  put(value.has_value(), key, fmt::format("{}", value.value_or(about.example.value_or(about.at_least))),
      style_ == YamlStyle::plain ? "" : fmt::format("whole number, at least {}; {}", about.at_least, about.meaning),
      Source::example);
}

void SectionWriter::value_of(const std::string& key, std::vector<std::int64_t>& values, const IntegerKey& about) {
  std::vector<std::int64_t> shown = values;
  if (values.empty()) shown = {about.example.value_or(1), about.example.value_or(1) + 1};
  put(!values.empty(), key, fmt::format("[{}]", fmt::join(shown, ", ")),
      style_ == YamlStyle::plain ? "" : fmt::format("whole numbers, at least {}; {}", about.at_least, about.meaning));
}

void SectionWriter::value_of(const std::string& key, std::vector<double>& values, const RealKey& about) {
  std::vector<std::string> texts;
  for (const double value : values.empty() ? about.examples : values) texts.push_back(shortest(value));
  if (texts.empty()) texts.assign(2, shortest(about.example.value_or(1.0)));
  put(!values.empty(), key, fmt::format("[{}]", fmt::join(texts, ", ")), comment_of(about));
}

void SectionWriter::value_of(const std::string& key, std::optional<std::string>& value, const TextKey& about) {
  put(value.has_value(), key, yaml_text(value.value_or(about.example)),
      style_ == YamlStyle::plain ? "" : "text; " + about.meaning);
}

void SectionWriter::value_of(const std::string& key, std::string& value, const TextKey& about) {
  put(true, key, yaml_text(value), style_ == YamlStyle::plain ? "" : "text; " + about.meaning);
}

void SectionWriter::value_of(const std::string& key, bool& value, const TextKey& about) {
  put(true, key, value ? "true" : "false", style_ == YamlStyle::plain ? "" : "true | false; " + about.meaning);
}

std::string SectionWriter::comment_of(const std::vector<Word>& words, const SectionKey& about) {
  if (style_ == YamlStyle::plain) return "";
  std::vector<std::string> names, choices;
  for (const Word& word : words) {
    names.push_back(word.name);
    choices.push_back(word.meaning.empty() ? word.name : fmt::format("{} ({})", word.name, word.meaning));
  }
  const std::string full = fmt::format("{}", fmt::join(choices, " | "));
  short_choices_[full] = fmt::format("{}", fmt::join(names, " | "));
  return fmt::format("{}{}; {}", about.required ? "required, " : "", full, about.meaning);
}

void SectionWriter::word(const std::string& key, std::size_t& index, const std::vector<Word>& words,
                         const SectionKey& about) {
  put(true, key, words[index].name, comment_of(words, about), source_of(about.required));
}

void SectionWriter::word(const std::string& key, std::optional<std::size_t>& index, const std::vector<Word>& words,
                         const SectionKey& about) {
  put(index.has_value(), key, words[index.value_or(0)].name, comment_of(words, about), Source::example);
}

void SectionWriter::word_list(const std::string& key, std::vector<std::size_t>& indices, const std::vector<Word>& words,
                              const SectionKey& about) {
  std::vector<std::string> names;
  for (const std::size_t index : indices) names.push_back(words[index].name);
  if (indices.empty()) names.push_back(words.front().name);
  put(!indices.empty(), key, fmt::format("[{}]", fmt::join(names, ", ")), comment_of(words, about));
}

// Asked of sections that a case may leave out.
bool SectionWriter::is_given(const std::string&, bool has_value) {
  optional_section_ = true;
  return has_value;
}

void SectionWriter::nested(const std::string& key, bool given, const SectionKey& about, const Body& body) {
  const bool given_outside = given_;
  const Source source = source_of(optional_section_);
  optional_section_ = false;
  if (!given && style_ == YamlStyle::plain) return;
  given = given && only_with_.empty();
  put(given, key, "", style_ == YamlStyle::plain ? "" : about.meaning, source);
  const std::size_t head = lines_.size() - 1;
  given_ = given_ && given;
  ++depth_;
  body(*this);
  --depth_;
  given_ = given_outside;

  std::size_t shown_inside = 0;
  for (std::size_t n = head + 1; n < lines_.size(); ++n) shown_inside += lines_[n].given ? 1 : 0;
  // Keys of other choices are left to a section that is shown in full.
  const auto own = std::find_if(lines_.begin() + static_cast<std::ptrdiff_t>(head) + 1, lines_.end(),
                                [&](const Line& line) { return !line.other_choice && line.depth == depth_ + 1; });
  const bool only_shorthand = !(about.in_full && style_ == YamlStyle::documented) && own != lines_.end() &&
                              own->key == about.shorthand && std::none_of(own + 1, lines_.end(), [&](const Line& line) {
                                return !line.other_choice && line.depth == depth_ + 1;
                              });
  if (only_shorthand) {
    lines_[head].value = own->value;
    if (style_ == YamlStyle::documented) lines_[head].comment = fmt::format("{}; {}", own->comment, about.meaning);
    lines_.resize(head + 1);
  } else if (shown_inside == 0 && lines_[head].given) {
    lines_[head].value = about.empty_name.empty() ? "{}" : about.empty_name;
  }
}

std::size_t SectionWriter::begin_list(const std::string& key, std::size_t size, const SectionKey& about) {
  put(true, key, size == 0 ? "[]" : "", style_ == YamlStyle::plain ? "" : about.meaning);
  return size;
}

void SectionWriter::item(const std::string&, std::size_t, const Body& body) {
  item_begins_ = true;
  depth_ += 2;
  body(*this);
  depth_ -= 2;
}

void SectionWriter::example_item(const Body& body) {
  if (style_ == YamlStyle::plain) return;
  const bool given_outside = given_;
  given_ = false;
  const std::size_t first = lines_.size();
  item("", 0, body);
  given_ = given_outside;
  if (lines_.size() > first) lines_[first].example = true;
}

std::string SectionWriter::text_of(const Line& line) {
  const std::size_t indent = 2 * static_cast<std::size_t>(line.depth - (line.item && !line.key.empty() ? 1 : 0));
  std::string text(indent, ' ');
  if (line.example) text += "# ";
  if (line.item) text += "- ";
  if (!line.given && !line.example) text += "# ";
  if (!line.key.empty()) text += line.key + ":" + (line.value.empty() ? "" : " ");
  text += line.value;
  if (!line.comment.empty()) {
    text.resize(std::max(text.size() + 2, comment_column), ' ');
    text += "# " + line.comment;
  }
  return text;
}

// Breaks a long comment at blanks; its other lines begin with "#   ".
std::string SectionWriter::folded(std::string text) {
  const std::string margin = std::string(comment_column, ' ') + "#   ";
  const std::size_t mark = text.find(" # ", std::min(text.size(), comment_column - 1));
  std::size_t begin = mark == std::string::npos ? text.size() : mark + 3;
  std::string result;
  while (text.size() > last_column && begin < text.size()) {
    std::size_t blank = text.rfind(' ', last_column);
    if (blank <= begin) blank = std::min(text.find(' ', last_column), text.size());
    result += text.substr(0, blank) + "\n";
    text.replace(0, std::min(blank + 1, text.size()), margin);
    begin = margin.size();
  }
  return text == margin ? result : result + text + "\n";
}

// Explains each list of choices once, where it is shown first.
std::string SectionWriter::yaml_of(std::span<const Line> lines) const {
  std::set<std::string> explained;
  std::string result;
  for (Line line : lines) {
    for (const auto& [full, brief] : short_choices_)
      if (const std::size_t at = line.comment.find(full + ";");
          at != std::string::npos && !explained.insert(full).second)
        line.comment.replace(at, full.size(), brief);
    result += style_ == YamlStyle::documented ? folded(text_of(line)) : text_of(line) + "\n";
  }
  return result;
}

std::string SectionWriter::yaml() const { return yaml_of(lines_); }

SectionWriter::Range SectionWriter::inside(std::size_t head) const {
  Range range{head + 1, head + 1};
  while (range.end < lines_.size() && lines_[range.end].depth > lines_[head].depth) ++range.end;
  return range;
}

std::vector<std::size_t> SectionWriter::heads_in(const Range& range) const {
  std::vector<std::size_t> heads;
  for (std::size_t n = range.begin; n < range.end; ++n)
    if (lines_[n].depth == lines_[range.begin].depth && !lines_[n].key.empty()) heads.push_back(n);
  return heads;
}

std::optional<std::string> SectionWriter::yaml_of(const std::vector<std::string>& path) const {
  Range range{0, lines_.size()};
  std::vector<Line> shown;
  int depth = -1;
  for (const std::string& name : path) {
    const std::vector<std::size_t> heads = heads_in(range);
    const auto found = std::find_if(heads.begin(), heads.end(), [&](std::size_t n) { return lines_[n].key == name; });
    if (found == heads.end()) return std::nullopt;
    Line head = lines_[*found];
    head.item = head.depth > depth + 1;  // the first that is shown of an entry of a list
    depth = head.depth;
    shown.push_back(head);
    range = inside(*found);
  }
  for (std::size_t n = range.begin; n < range.end; ++n) shown.push_back(lines_[n]);
  return yaml_of(shown);
}

std::vector<std::string> SectionWriter::sections() const {
  std::vector<std::string> names;
  for (const std::size_t head : heads_in({0, lines_.size()}))
    if (const Range range = inside(head); range.end > range.begin) names.push_back(lines_[head].key);
  return names;
}

}  // namespace thalweg::io
