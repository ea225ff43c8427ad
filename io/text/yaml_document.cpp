#include "io/text/yaml_document.hpp"

#include "core/base/error_message.hpp"
#include "core/base/utf8.hpp"
#include "core/parallel/on_first_rank.hpp"
#include "io/files/atomic_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>

namespace thalweg::io {
namespace {

constexpr int deepest = 32;  // levels: more are a file gone wrong, or one that contains itself

using PlaceOf = std::function<std::string(const YAML::Mark&)>;

// Counts the values of a tree. Every alias (*name) is a copy of what it stands for, so that a few lines could fill the
// memory; what a text writes out itself has less values than characters, and is not refused.
class ValueCount {
public:
  explicit ValueCount(std::size_t characters) : most_(std::max(most_with_aliases, characters)) {}
  void add(const std::string& place, const std::string& key_path) {
    if (++count_ > most_)
      throw InputError(
          fmt::format("{}: {}: with its aliases (*name) the file has more than {} values; write out what is meant.",
                      place, key_path, most_));
  }

private:
  static constexpr std::size_t most_with_aliases = 1000000;
  std::size_t count_ = 0, most_;
};

YamlNode converted(const YAML::Node& node, const std::string& place, const std::string& key_path,
                   const PlaceOf& location_of, int depth, ValueCount& count) {
  if (depth > deepest)
    throw InputError(fmt::format("{}: {}: the file is nested more than {} levels deep.", place, key_path, deepest));
  count.add(place, key_path);
  YamlNode result;
  result.place = place;
  if (node.IsMap()) {
    result.kind = YamlNode::Kind::section;
    std::map<std::string, std::string> known;  // keys, and where they are given
    for (const auto& entry : node) {
      const std::string here = location_of(entry.first.Mark());
      if (!entry.first.IsScalar())
        throw InputError(fmt::format("{}: {}: a key must be a single word.", here, key_path));
      const std::string key = entry.first.Scalar();
      const std::string path = joined_key(key_path, key);
      if (const auto [first, is_new] = known.emplace(key, here); !is_new)
        throw InputError(fmt::format("{}: {}: the key is given twice (first at {}); remove one of the two.", here, path,
                                     first->second));
      result.entries.push_back({key, converted(entry.second, here, path, location_of, depth + 1, count)});
    }
  } else if (node.IsSequence()) {
    result.kind = YamlNode::Kind::list;
    for (const auto& item : node)
      result.items.push_back(converted(item, location_of(item.Mark()),
                                       joined_key(key_path, fmt::format("{}", result.items.size())), location_of,
                                       depth + 1, count));
  } else {
    result.kind = YamlNode::Kind::scalar;
    if (node.IsScalar()) result.text = node.Scalar();
    if (result.text.find('\0') != std::string::npos)
      throw InputError(fmt::format("{}: {}: a text must not have a zero character.", place, key_path));
  }
  return result;
}

// A lone carriage return would be part of a word.
std::size_t lone_return(std::string_view text) {
  std::size_t at = text.find('\r');
  while (at != std::string_view::npos && text.substr(at + 1, 1) == "\n") at = text.find('\r', at + 1);
  return at;
}

// The first character that is none of a text; the size of the text if there is none.
std::size_t first_control_character(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size() &&
         (text[at] == '\t' || text[at] == '\n' || text[at] == '\r' || !control_character(text.substr(at))))
    ++at;
  return at;
}

std::string place_of_byte(std::string_view text, std::size_t at, const PlaceOf& location_of) {
  YAML::Mark mark;
  mark.line = static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
  return location_of(mark);
}

// Refuses bytes that YAML does not allow in a text, and that its parser might take for the end of the file.
void refuse_odd_bytes(std::string_view text, const PlaceOf& location_of) {
  const auto place_at = [&](std::size_t at) { return place_of_byte(text, at, location_of); };
  if (const std::size_t at = first_not_utf8(text); at < text.size())
    throw InputError(fmt::format("{}: the byte {:#04x} here is not UTF-8; save the text as UTF-8.", place_at(at),
                                 static_cast<unsigned char>(text[at])));
  if (const std::size_t at = lone_return(text); at != std::string_view::npos)
    throw InputError(
        fmt::format("{}: a carriage return without a line feed stands here or below; save the text with "
                    "the line ends of Unix or Windows.",
                    place_at(at)));
  if (const std::size_t at = first_control_character(text); at < text.size())
    throw InputError(fmt::format("{}: a control character, {:#04x}, stands here; remove it, or save the file as text.",
                                 place_at(at), control_character(text.substr(at)).value()));
}

// The first tab before the words of a line; npos if there is none.
std::size_t tab_in_indentation(std::string_view text) {
  for (std::size_t at = text.find('\t'); at != std::string_view::npos; at = text.find('\t', at + 1)) {
    const std::size_t before = text.find_last_not_of(' ', at == 0 ? 0 : at - 1);
    if (at == 0 || before == std::string_view::npos || text[before] == '\n') return at;
  }
  return std::string_view::npos;
}

YamlNode parsed(const std::string& text, const PlaceOf& location_of, const std::string& whole_place,
                const std::string& key_path) {
  refuse_odd_bytes(text, location_of);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    for (std::size_t n = 1; n < documents.size(); ++n)
      if (!documents[n].IsNull())
        throw InputError(fmt::format(
            "{}: a second document begins here, after a line ---, and would be ignored; remove that line, or "
            "what follows it.",
            location_of(documents[n].Mark())));
    ValueCount count(text.size());
    return converted(documents.empty() ? YAML::Node() : documents.front(), whole_place, key_path, location_of, 0,
                     count);
  } catch (const YAML::Exception& error) {
    if (const std::size_t tab = tab_in_indentation(text); tab != std::string::npos)
      throw InputError(fmt::format("{}: this line is indented with a tab, which YAML does not allow; use spaces.",
                                   place_of_byte(text, tab, location_of)));
    const std::string place = error.mark.is_null() ? whole_place : location_of(error.mark);
    throw InputError(
        fmt::format("{}: this is not valid YAML: {}; look for a missing colon, bracket or quote and for "
                    "uneven indentation here or just above.",
                    place, error.msg));
  }
}

bool is_number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

YamlNode* entry_of(YamlNode& section, const std::string& key) { return const_cast<YamlNode*>(section.find(key)); }

YamlNode* item_of(YamlNode& list, const std::string& key) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (error != std::errc() || end != key.data() + key.size() || index >= list.items.size()) return nullptr;
  return &list.items[index];
}

std::vector<std::string> split_key(const std::string& key_path) {
  std::vector<std::string> parts;
  std::size_t start = 0;
  while (true) {
    const std::size_t dot = key_path.find('.', start);
    parts.push_back(key_path.substr(start, dot - start));
    if (dot == std::string::npos) return parts;
    start = dot + 1;
  }
}

void erase_entry(YamlNode& section, const std::string& key) {
  std::erase_if(section.entries, [&](const auto& entry) { return entry.key == key; });
}

}  // namespace

const YamlNode* YamlNode::find(const std::string& key) const {
  for (const auto& [name, value] : entries)
    if (name == key) return &value;
  return nullptr;
}

std::string joined_key(const std::string& section, const std::string& key) {
  return section.empty() ? key : section + "." + key;
}

std::string shown(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::section)
    return fmt::format("a section with {} key{}", node.entries.size(), node.entries.size() == 1 ? "" : "s");
  if (node.kind == YamlNode::Kind::scalar) return is_number(node.text) ? node.text : fmt::format("\"{}\"", node.text);
  constexpr std::size_t most = 6;
  std::string text = "[";
  for (std::size_t n = 0; n < node.items.size() && n < most; ++n) text += (n ? ", " : "") + shown(node.items[n]);
  return text + (node.items.size() > most ? ", ...]" : "]");
}

YamlNode parsed_yaml(const std::string& text, const std::string& name) {
  return parsed(
      text, [&name](const YAML::Mark& mark) { return fmt::format("{}:{}", name, mark.line + 1); }, name + ":1", "");
}

YamlDocument::YamlDocument(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                           const Ranks& ranks)
    : path_(path) {
  const std::string name = path.string();
  const auto location_of = [&](const YAML::Mark& mark) { return fmt::format("{}:{}", name, mark.line + 1); };
  const std::string text = told_by_first_rank(ranks.communicator(), [&] {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
      throw InputError(fmt::format("{}: this is a folder: give the case file itself, for example {}.", name,
                                   (path / "case.yaml").string()));
    return read_text(path);
  });
  root_ = parsed(text, location_of, name + ":1", "");
  if (root_.kind == YamlNode::Kind::scalar && root_.text.empty()) root_.kind = YamlNode::Kind::section;
  if (root_.kind != YamlNode::Kind::section)
    throw InputError(fmt::format("{}:1: expected keys with values, for example system: resolved.", name));
  for (const std::string& override_text : overrides) apply(override_text, "--set " + override_text);
}

void YamlDocument::complete(const std::string& key_path, const std::string& value, const std::string& from) {
  const YamlNode* node = find(key_path);
  if (!node) node = find(from);
  apply(key_path + "=" + value, std::string((node ? *node : root_).place));
}

void YamlDocument::apply(const std::string& override_text, const std::string& place) {
  const std::size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(fmt::format("{}: expected KEY=VALUE, for example --set run.until=10.", place));
  const std::string key_path = override_text.substr(0, equals);
  const std::string value_text = override_text.substr(equals + 1);
  if (value_text.find_first_not_of(" \t") == std::string::npos)
    throw InputError(fmt::format("{}: the value is missing; give one, or null to remove the key.", place));
  YamlNode value = parsed(
      value_text, [&](const YAML::Mark&) { return place; }, place, key_path);
  const bool remove = value.kind == YamlNode::Kind::scalar && value.text.empty();  // null

  YamlNode* node = &root_;
  std::string done;
  const std::vector<std::string> parts = split_key(key_path);
  for (std::size_t n = 0; n < parts.size(); ++n) {
    const std::string& key = parts[n];
    const bool last = n + 1 == parts.size();
    YamlNode* next = nullptr;
    if (node->kind == YamlNode::Kind::scalar && !node->text.empty())
      throw InputError(fmt::format("{}: {} = {} is a single value and has no key {}; set {} itself.", place, done,
                                   shown(*node), key, done));
    if (node->kind == YamlNode::Kind::list) {
      next = item_of(*node, key);
      if (!next)
        throw InputError(fmt::format("{}: {} is a list of {} and has no entry \"{}\"; count from 0.", place, done,
                                     node->items.size(), key));
      if (remove && last)
        throw InputError(
            fmt::format("{}: an entry of a list cannot be removed; set all of {}, or remove all of it.", place, done));
    } else {
      next = entry_of(*node, key);
      if (remove && last) erase_entry(*node, key);
      if (remove && (last || !next)) {  // no section comes into being that would have had the key
        taken_out_.push_back({key_path, place});
        return;
      }
      node->kind = YamlNode::Kind::section;
      if (!next) {
        node->entries.push_back({key, {}});
        next = &node->entries.back().value;
        next->place = place;
      }
    }
    node = next;
    done = joined_key(done, key);
  }
  *node = std::move(value);
}

LaidBeneath YamlDocument::lay_beneath(const YamlNode& other, const std::vector<std::string>& without) {
  LaidBeneath keys;
  std::vector<std::string> all = without;
  for (const TakenOut& key : taken_out_) all.push_back(key.key_path);
  lay_beneath(root_, other, "", all, keys);
  return keys;
}

void YamlDocument::lay_beneath(YamlNode& section, const YamlNode& other, const std::string& key_path,
                               const std::vector<std::string>& without, LaidBeneath& keys) const {
  for (const auto& [key, value] : other.entries) {
    const std::string path = joined_key(key_path, key);
    YamlNode* own = entry_of(section, key);
    const bool empty = own && own->kind == YamlNode::Kind::scalar && own->text.empty();
    const bool unwanted = std::find(without.begin(), without.end(), path) != without.end();
    const bool merges =
        value.kind == YamlNode::Kind::section && (!own || empty || own->kind == YamlNode::Kind::section);
    if (unwanted || (own && !merges)) {
      keys.left_out.push_back(path);
    } else if (merges) {
      YamlNode inside;
      inside.place = own ? own->place : section.place;  // what is missing in it is missing in this file
      if (own && !empty) inside = *own;
      lay_beneath(inside, value, path, without, keys);
      if (own)
        *own = std::move(inside);
      else if (!inside.entries.empty())
        section.entries.push_back({key, std::move(inside)});
    } else {
      section.entries.push_back({key, value});
      keys.added.push_back(fmt::format("{}: {}", path, value.text));
    }
  }
}

std::string YamlDocument::path_beside(const std::string& file, const std::string& key_path) const {
  // As the system finds a path with "..": from the folder itself, not from a link to it.
  const std::filesystem::path folder = std::filesystem::absolute(path_).parent_path();
  std::error_code unknown;
  const std::filesystem::path real = std::filesystem::weakly_canonical(folder, unknown);
  std::string path = ((unknown ? folder : real) / file).lexically_normal().string();
  if (!is_utf8(path))
    throw error(key_path,
                fmt::format("the name of a folder in {} is not UTF-8, and case.yaml must be; rename the folder",
                            as_utf8(path)));
  return path;
}

const YamlNode* YamlDocument::find(const std::string& key_path) const {
  const YamlNode* node = &root_;
  for (const std::string& key : split_key(key_path)) {
    node = node->kind == YamlNode::Kind::list ? item_of(const_cast<YamlNode&>(*node), key) : node->find(key);
    if (!node) return nullptr;
  }
  return node;
}

InputError YamlDocument::error(const std::string& key_path, const std::string& remedy) const {
  if (const YamlNode* node = find(key_path))
    return InputError(fmt::format("{}: {} = {}: {}.", node->place, key_path, shown(*node), remedy));
  std::string section = key_path;
  const YamlNode* node = nullptr;
  while (!node) {
    const std::size_t dot = section.rfind('.');
    if (dot == std::string::npos) break;
    section.resize(dot);
    node = find(section);
  }
  return InputError(fmt::format("{}: {}: {}.", (node ? *node : root_).place, key_path, remedy));
}

InputError YamlDocument::error(const std::string& key_path, const InputError& of_file) const {
  return error(key_path, without_full_stop(of_file.what()));
}

}  // namespace thalweg::io
