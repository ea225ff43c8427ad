#include "io/files/json_object.hpp"

#include "core/base/utf8.hpp"
#include "io/files/atomic_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace thalweg::io {
namespace {

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

std::string json_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : as_utf8(text)) {
    if (c == '"' || c == '\\')
      result += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + "\"";
}

}  // namespace

JsonObject& JsonObject::put(const std::string& name, std::string line, std::string text) {
  for (Entry& entry : entries_)
    if (entry.name == name) {
      entry = {name, std::move(line), std::move(text)};
      return *this;
    }
  entries_.push_back({name, std::move(line), std::move(text)});
  return *this;
}

JsonObject& JsonObject::set(const std::string& name, double value) { return put(name, number(value), number(value)); }

JsonObject& JsonObject::set(const std::string& name, std::int64_t value) {
  return put(name, fmt::format("{}", value), fmt::format("{}", value));
}

JsonObject& JsonObject::set(const std::string& name, bool value) {
  return put(name, value ? "true" : "false", value ? "true" : "false");
}

JsonObject& JsonObject::set(const std::string& name, const std::string& value) {
  return put(name, json_text(value), json_text(value));
}

JsonObject& JsonObject::set(const std::string& name, const JsonObject& value) {
  return put(name, value.line(), value.text());
}

JsonObject& JsonObject::set_json(const std::string& name, const std::string& json) {
  const std::string value = json.substr(0, json.find_last_not_of(" \n") + 1);
  return put(name, value, value);
}

JsonObject& JsonObject::set(const std::string& name, const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(number(value));
  const std::string list = fmt::format("[{}]", fmt::join(texts, ", "));
  return put(name, list, list);
}

JsonObject& JsonObject::set(const std::string& name, const std::vector<std::string>& values) {
  std::vector<std::string> texts;
  for (const std::string& value : values) texts.push_back(json_text(value));
  const std::string list = fmt::format("[{}]", fmt::join(texts, ", "));
  return put(name, list, list);
}

JsonObject& JsonObject::set(const std::string& name, const std::vector<JsonObject>& values) {
  std::vector<std::string> lines, texts;
  for (const JsonObject& value : values) {
    lines.push_back(value.line());
    texts.push_back(value.text());
  }
  return put(name, fmt::format("[{}]", fmt::join(lines, ", ")), fmt::format("[{}]", fmt::join(texts, ", ")));
}

std::string JsonObject::line() const {
  std::vector<std::string> parts;
  for (const Entry& entry : entries_) parts.push_back(json_text(entry.name) + ": " + entry.line);
  return fmt::format("{{{}}}", fmt::join(parts, ", "));
}

std::string JsonObject::text() const {
  if (entries_.empty()) return "{}";
  std::string result = "{";
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    result += (n ? ",\n  " : "\n  ") + json_text(entries_[n].name) + ": ";
    for (const char c : entries_[n].text) result += c == '\n' ? std::string("\n  ") : std::string(1, c);
  }
  return result + "\n}";
}

void JsonObject::write(const std::filesystem::path& path) const { write_text_atomically(path, text() + "\n"); }

}  // namespace thalweg::io
