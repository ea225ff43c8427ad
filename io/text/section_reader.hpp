// The visitor that fills a struct from a section of a YAML document and complains about everything that does not fit.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "io/text/yaml_document.hpp"

namespace thalweg::io {

// Throws InputError at the first thing wrong; unknown keys before what is missing, which is most often misspelt.
class SectionReader final : public SectionVisitor {
public:
  // The section of `document` at key_path ("": the root), which must exist.
  SectionReader(const YamlDocument& document, std::string key_path, const YamlNode& section);

  void not_here(const std::string& key, const std::string& reason) override;
  void require(bool condition, const std::string& key, const std::string& remedy) override;
  bool reading() const override { return true; }

  void finish() const;  // throws InputError for an unknown key, with the nearest known one, then for a missing one

private:
  void value_of(const std::string& key, double& value, const RealKey& about) override;
  void value_of(const std::string& key, std::optional<double>& value, const RealKey& about) override;
  void value_of(const std::string& key, Vec3& value, const RealKey& about) override;
  void value_of(const std::string& key, std::optional<Vec3>& value, const RealKey& about) override;
  void value_of(const std::string& key, std::vector<Vec3>& values, const RealKey& about) override;
  void value_of(const std::string& key, std::int64_t& value, const IntegerKey& about) override;
  void value_of(const std::string& key, std::optional<std::int64_t>& value, const IntegerKey& about) override;
  void value_of(const std::string& key, std::vector<std::int64_t>& values, const IntegerKey& about) override;
  void value_of(const std::string& key, std::vector<double>& values, const RealKey& about) override;
  void value_of(const std::string& key, std::string& value, const TextKey& about) override;
  void value_of(const std::string& key, std::optional<std::string>& value, const TextKey& about) override;
  void value_of(const std::string& key, bool& value, const TextKey& about) override;
  void word(const std::string& key, std::size_t& index, const std::vector<Word>& words,
            const SectionKey& about) override;
  void word(const std::string& key, std::optional<std::size_t>& index, const std::vector<Word>& words,
            const SectionKey& about) override;
  void word_list(const std::string& key, std::vector<std::size_t>& indices, const std::vector<Word>& words,
                 const SectionKey& about) override;
  bool is_given(const std::string& key, bool has_value) override;
  void nested(const std::string& key, bool given, const SectionKey& about, const Body& body) override;
  std::size_t begin_list(const std::string& key, std::size_t size, const SectionKey& about) override;
  void item(const std::string& key, std::size_t index, const Body& body) override;

  // The value of a key, null where it is not given; a missing required key is an error that says what to give.
  const YamlNode* look_up(const std::string& key, bool required, const std::string& expectation);
  double real_from(const YamlNode& node, const std::string& key, const RealKey& about,
                   const std::string& expectation) const;
  Vec3 vec3_from(const YamlNode& node, const std::string& key, const RealKey& about,
                 const std::string& expectation) const;
  std::size_t word_from(const YamlNode& node, const std::string& key, const std::vector<Word>& words,
                        const SectionKey& about) const;
  void read_inside(const YamlNode& node, const std::string& key, const SectionKey& about, const Body& body);
  void note_missing(const std::string& complaint);
  void refuse_unknown() const;
  std::string remedy_of_unknown(const std::string& key) const;
  [[noreturn]] void fail(const YamlNode& node, const std::string& key, const std::string& remedy) const;

  const YamlDocument& document_;
  std::string key_path_;
  const YamlNode& section_;
  std::optional<std::string> shorthand_;  // the key that a plain value in place of the section stands for
  std::vector<std::string> known_;        // every key asked for, in order
  std::vector<std::string> elsewhere_;    // keys that other cases have
  std::string missing_;                   // the complaint about the first required key that is not given, here or below
};

// Reads a whole document into a struct described for SectionVisitor.
template <typename Section>
void read_document(const YamlDocument& document, Section& value) {
  SectionReader reader(document, "", document.root());
  describe(reader, value);
  reader.finish();
}

}  // namespace thalweg::io
