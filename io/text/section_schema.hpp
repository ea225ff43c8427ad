// The visitor that describes a struct as a JSON schema (draft 7): for editors that complete and check a case as it is
// written.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "io/files/json_object.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::io {

// Every key with its type, range, words, unit and meaning; keys that are not described are errors. What is required is
// left to the reader, because a preset may give it, and so is what follows from several keys together.
class SectionSchema final : public SectionVisitor {
public:
  void not_here(const std::string&, const std::string&) override {}
  void require(bool, const std::string&, const std::string&) override {}
  bool reading() const override { return false; }

  JsonObject schema() const { return object_of(levels_.back()); }

private:
  using Properties = std::vector<std::pair<std::string, JsonObject>>;

  static JsonObject object_of(const Properties& properties);
  void add(const std::string& key, JsonObject property) { levels_.back().emplace_back(key, std::move(property)); }
  Properties inside(const Body& body);

  void value_of(const std::string& key, double&, const RealKey& about) override;
  void value_of(const std::string& key, std::optional<double>&, const RealKey& about) override;
  void value_of(const std::string& key, Vec3&, const RealKey& about) override;
  void value_of(const std::string& key, std::optional<Vec3>&, const RealKey& about) override;
  void value_of(const std::string& key, std::vector<Vec3>&, const RealKey& about) override;
  void value_of(const std::string& key, std::int64_t&, const IntegerKey& about) override;
  void value_of(const std::string& key, std::optional<std::int64_t>&, const IntegerKey& about) override;
  void value_of(const std::string& key, std::vector<std::int64_t>&, const IntegerKey& about) override;
  void value_of(const std::string& key, std::vector<double>&, const RealKey& about) override;
  void value_of(const std::string& key, std::string&, const TextKey& about) override;
  void value_of(const std::string& key, std::optional<std::string>&, const TextKey& about) override;
  void value_of(const std::string& key, bool&, const TextKey& about) override;
  void word(const std::string& key, std::size_t&, const std::vector<Word>& words, const SectionKey& about) override;
  void word(const std::string& key, std::optional<std::size_t>&, const std::vector<Word>& words,
            const SectionKey& about) override;
  void word_list(const std::string& key, std::vector<std::size_t>&, const std::vector<Word>& words,
                 const SectionKey& about) override;
  bool is_given(const std::string&, bool has_value) override { return has_value; }
  void nested(const std::string& key, bool given, const SectionKey& about, const Body& body) override;
  std::size_t begin_list(const std::string& key, std::size_t size, const SectionKey& about) override;
  void item(const std::string&, std::size_t, const Body&) override {}
  void example_item(const Body& body) override;
  bool shows_key_with(const std::string&) override { return true; }

  std::vector<Properties> levels_{1};
  std::string list_key_, list_meaning_;  // of the list whose item comes next
};

}  // namespace thalweg::io
