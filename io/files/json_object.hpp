// A JSON object, written once: summary.json and the lines of the benchmarks.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {

// Entries keep the order in which they are first set; setting a name again replaces its value. A number that is not
// finite becomes null, as JSON has no word for it.
class JsonObject {
public:
  JsonObject& set(const std::string& name, double value);
  JsonObject& set(const std::string& name, std::int64_t value);
  JsonObject& set(const std::string& name, int value) { return set(name, static_cast<std::int64_t>(value)); }
  JsonObject& set(const std::string& name, bool value);
  JsonObject& set(const std::string& name, const std::string& value);
  JsonObject& set(const std::string& name, const char* value) { return set(name, std::string(value)); }
  JsonObject& set(const std::string& name, const JsonObject& value);
  JsonObject& set_json(const std::string& name, const std::string& json);  // a value that is JSON already
  JsonObject& set(const std::string& name, const std::vector<double>& values);
  JsonObject& set(const std::string& name, const std::vector<std::string>& values);
  JsonObject& set(const std::string& name, const std::vector<JsonObject>& values);

  std::string line() const;                             // on one line
  std::string text() const;                             // indented, one entry a line
  void write(const std::filesystem::path& path) const;  // atomically; throws RunError

private:
  struct Entry {
    std::string name;
    std::string line;  // the value on one line
    std::string text;  // the value over several lines
  };
  JsonObject& put(const std::string& name, std::string line, std::string text);

  std::vector<Entry> entries_;
};

}  // namespace thalweg::io
