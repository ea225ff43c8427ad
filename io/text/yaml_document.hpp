// A YAML file as a tree in which every value knows its place in the file, so that every error message can give it.
#pragma once

#include "core/base/error.hpp"
#include "core/parallel/ranks.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::io {

struct YamlEntry;

struct YamlNode {
  enum class Kind { scalar, section, list };

  Kind kind = Kind::section;
  std::string text;                // of a scalar; empty for null
  std::vector<YamlEntry> entries;  // of a section, in the order of the file
  std::vector<YamlNode> items;     // of a list
  std::string place;               // "cases/x/case.yaml:12" or "--set fluid.density=water"

  const YamlNode* find(const std::string& key) const;  // entry of a section; null if there is none
};

struct YamlEntry {
  std::string key;
  YamlNode value;
};

// The text as a tree; name: of its places, "<name>:<line>". Throws InputError as a document does.
YamlNode parsed_yaml(const std::string& text, const std::string& name);

// Outcome of lay_beneath(): "fluid.collision: bgk" for each value of the other tree that was added, and the key paths
// of those that were not.
struct LaidBeneath {
  std::vector<std::string> added, left_out;
};

// A key that an override has taken out, whether the file has it or not.
struct TakenOut {
  std::string key_path, place;
};

class YamlDocument {
public:
  // An empty document: its errors name no place.
  YamlDocument() = default;

  // Reads a file, on the first of the ranks, then applies the overrides ("key.sub=VALUE", VALUE being YAML itself; list
  // items by index). Collective.
  // Throws InputError: missing file, not UTF-8, control characters, YAML syntax, duplicate key, more than one document,
  // aliases that multiply to more than a million values, an override that names no key.
  YamlDocument(const std::filesystem::path& path, const std::vector<std::string>& overrides, const Ranks& ranks = {});

  // Gives a key a value that follows from another key of the document: as an override does, but its place stays where
  // it has one, and is else that of the other key.
  void complete(const std::string& key_path, const std::string& value, const std::string& from);

  // Adds the values of another tree, section by section, where the document has none of the same key, no override has
  // taken it out, and it is not one of `without` or inside it.
  LaidBeneath lay_beneath(const YamlNode& other, const std::vector<std::string>& without);

  const YamlNode& root() const { return root_; }
  const std::vector<TakenOut>& taken_out() const { return taken_out_; }
  const std::filesystem::path& path() const { return path_; }

  // The absolute path of a file that a key gives relative to the document. Throws InputError where it is not UTF-8.
  std::string path_beside(const std::string& file, const std::string& key_path) const;

  // The value at "fluid.density" or "grains.0.count"; null if there is none.
  const YamlNode* find(const std::string& key_path) const;

  // The error of a value: "<place>: <key path> = <value found>: <remedy>.", or, where the key is not given, the place
  // of the section it belongs to and "<key path>: <remedy>.".
  InputError error(const std::string& key_path, const std::string& remedy) const;
  // The same of what was wrong with the file that a value names.
  InputError error(const std::string& key_path, const InputError& of_file) const;

private:
  void apply(const std::string& override_text, const std::string& place);
  void lay_beneath(YamlNode& section, const YamlNode& other, const std::string& key_path,
                   const std::vector<std::string>& without, LaidBeneath& keys) const;

  std::filesystem::path path_;
  YamlNode root_;
  std::vector<TakenOut> taken_out_;
};

// The value as an error message shows it: "water" in quotes, a number bare, [0, 1] or "a section with 3 keys".
std::string shown(const YamlNode& node);

// "fluid" and "density" -> "fluid.density"; "" and "fluid" -> "fluid".
std::string joined_key(const std::string& section, const std::string& key);

}  // namespace thalweg::io
