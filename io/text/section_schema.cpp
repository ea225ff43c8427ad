#include "io/text/section_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg::io {
namespace {

JsonObject of_type(const char* type, const std::string& meaning) {
  JsonObject schema;
  schema.set("type", type);
  if (!meaning.empty()) schema.set("description", meaning);
  return schema;
}

JsonObject number_of(const RealKey& about) {
  JsonObject schema = of_type("number", "");
  if (about.above) schema.set("exclusiveMinimum", *about.above);
  if (about.at_least) schema.set("minimum", *about.at_least);
  if (about.below) schema.set("exclusiveMaximum", *about.below);
  if (about.at_most) schema.set("maximum", *about.at_most);
  return schema;
}

JsonObject with_meaning(JsonObject schema, const RealKey& about) {
  return schema.set("description", about.unit == "1" ? about.meaning : about.unit + "; " + about.meaning)
      .set("unit", about.unit);
}

JsonObject list_of(const JsonObject& items, int fewest = 0, int most = 0) {
  JsonObject schema = of_type("array", "");
  schema.set("items", items);
  if (fewest > 0) schema.set("minItems", fewest);
  if (most > 0) schema.set("maxItems", most);
  return schema;
}

JsonObject vec3_of(const RealKey& about) { return list_of(number_of(about), about.fewest_numbers, 3); }

JsonObject integer_of(const IntegerKey& about) {
  JsonObject schema = of_type("integer", about.meaning);
  schema.set("minimum", about.at_least);
  if (!about.automatic) return schema;
  JsonObject any;
  any.set("description", about.meaning);
  return any.set("anyOf", std::vector<JsonObject>{schema, JsonObject().set("const", "auto")});
}

}  // namespace

JsonObject SectionSchema::object_of(const Properties& properties) {
  JsonObject all, schema;
  for (const auto& [key, property] : properties) all.set(key, property);
  return schema.set("type", "object").set("properties", all).set("additionalProperties", false);
}

SectionSchema::Properties SectionSchema::inside(const Body& body) {
  levels_.emplace_back();
  body(*this);
  Properties properties = std::move(levels_.back());
  levels_.pop_back();
  return properties;
}

void SectionSchema::value_of(const std::string& key, double&, const RealKey& about) {
  add(key, with_meaning(number_of(about), about));
}

void SectionSchema::value_of(const std::string& key, std::optional<double>&, const RealKey& about) {
  add(key, with_meaning(number_of(about), about));
}

void SectionSchema::value_of(const std::string& key, Vec3&, const RealKey& about) {
  add(key, with_meaning(vec3_of(about), about));
}

void SectionSchema::value_of(const std::string& key, std::optional<Vec3>&, const RealKey& about) {
  add(key, with_meaning(vec3_of(about), about));
}

void SectionSchema::value_of(const std::string& key, std::vector<Vec3>&, const RealKey& about) {
  add(key, with_meaning(list_of(vec3_of(about)), about));
}

void SectionSchema::value_of(const std::string& key, std::int64_t&, const IntegerKey& about) {
  add(key, integer_of(about));
}

void SectionSchema::value_of(const std::string& key, std::optional<std::int64_t>&, const IntegerKey& about) {
  add(key, integer_of(about));
}

void SectionSchema::value_of(const std::string& key, std::vector<std::int64_t>&, const IntegerKey& about) {
  add(key, list_of(integer_of(about)).set("description", about.meaning));
}

void SectionSchema::value_of(const std::string& key, std::vector<double>&, const RealKey& about) {
  add(key, with_meaning(list_of(number_of(about)), about));
}

// Numbers and truth values, too, are read as the text that they are.
void SectionSchema::value_of(const std::string& key, std::string&, const TextKey& about) {
  add(key, JsonObject()
               .set("type", std::vector<std::string>{"string", "number", "boolean"})
               .set("description", about.meaning));
}

void SectionSchema::value_of(const std::string& key, std::optional<std::string>&, const TextKey& about) {
  std::string text;
  value_of(key, text, about);
}

void SectionSchema::value_of(const std::string& key, bool&, const TextKey& about) {
  add(key, of_type("boolean", about.meaning));
}

void SectionSchema::word(const std::string& key, std::size_t&, const std::vector<Word>& words,
                         const SectionKey& about) {
  std::vector<std::string> names;
  std::string meaning = about.meaning;
  for (const Word& word : words) {
    names.push_back(word.name);
    if (!word.meaning.empty()) meaning += fmt::format("\n{}: {}", word.name, word.meaning);
  }
  add(key, JsonObject().set("enum", names).set("description", meaning));
}

void SectionSchema::word(const std::string& key, std::optional<std::size_t>&, const std::vector<Word>& words,
                         const SectionKey& about) {
  std::size_t first = 0;
  word(key, first, words, about);
}

void SectionSchema::word_list(const std::string& key, std::vector<std::size_t>&, const std::vector<Word>& words,
                              const SectionKey& about) {
  std::size_t first = 0;
  word(key, first, words, about);
  JsonObject& one = levels_.back().back().second;
  one = list_of(one).set("description", about.meaning);
}

void SectionSchema::nested(const std::string& key, bool, const SectionKey& about, const Body& body) {
  const Properties properties = inside(body);
  const JsonObject section = object_of(properties);
  std::vector<JsonObject> forms{section, of_type("null", "")};
  const auto shorthand = std::find_if(properties.begin(), properties.end(),
                                      [&](const auto& property) { return property.first == about.shorthand; });
  if (shorthand != properties.end()) forms.push_back(shorthand->second);
  if (!about.empty_name.empty()) forms.push_back(JsonObject().set("const", about.empty_name));
  add(key, JsonObject().set("description", about.meaning).set("anyOf", forms));
}

// The items of the case at hand may lack keys that others have: one is described as it is by default.
std::size_t SectionSchema::begin_list(const std::string& key, std::size_t, const SectionKey& about) {
  list_key_ = key;
  list_meaning_ = about.meaning;
  return 0;
}

void SectionSchema::example_item(const Body& body) {
  const std::string key = list_key_, meaning = list_meaning_;
  add(key, list_of(object_of(inside(body))).set("description", meaning));
}

}  // namespace thalweg::io
