// The visitor that shows a struct as YAML: plainly, with units behind the numbers, or as documentation.
#pragma once

#include "core/keys/section_visitor.hpp"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::io {

// plain: every key that has a value, its unit as a comment. documented: meanings as well, and the keys that are not
// given as comments, so that the text is both a valid file and the reference of all keys, in lines of at most 110
// columns; a value that is no default is marked as an example.
enum class YamlStyle { plain, documented };

class SectionWriter final : public SectionVisitor {
public:
  explicit SectionWriter(YamlStyle style) : style_(style) {}

  void not_here(const std::string&, const std::string&) override {}
  void require(bool, const std::string&, const std::string&) override {}
  bool reading() const override { return false; }

  std::string yaml() const;

  // The section, or key, of that path alone ("contact", "liquid_bridge"; entries of lists count as one), under the
  // lines of the sections it is in; none where there is no such path.
  std::optional<std::string> yaml_of(const std::vector<std::string>& path) const;
  std::vector<std::string> sections() const;  // names of those at the top

private:
  // Source of a shown value: the default, or an example chosen for the documentation because the key has no default.
  enum class Source { default_value, example };
  static Source source_of(bool no_default) { return no_default ? Source::example : Source::default_value; }
  struct Line {
    bool given;  // false: shown as a comment
    bool item;   // the first line of an entry of a list
    int depth;   // in sections
    std::string key, value, comment;
    bool example = false;       // with item: of an entry that is a comment altogether
    bool other_choice = false;  // a key that this case cannot have
  };
  struct Range {
    std::size_t begin, end;  // of lines
  };
  static std::string text_of(const Line& line);  // without a line end
  static std::string folded(std::string text);   // with line ends
  std::string yaml_of(std::span<const Line> lines) const;
  Range inside(std::size_t head) const;                         // the lines behind it that are deeper
  std::vector<std::size_t> heads_in(const Range& range) const;  // lines with the keys of the first level there

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
  void example_item(const Body& body) override;
  bool shows_key_with(const std::string& choice) override;

  // True if a value is that of the case, not an example of a key that is not given.
  bool value_shown() const { return given_ && only_with_.empty(); }
  void put(bool given, const std::string& key, const std::string& value, const std::string& comment,
           Source source = Source::default_value);
  std::string comment_of(const RealKey& about) const;
  std::string comment_of(const std::vector<Word>& words, const SectionKey& about);

  YamlStyle style_;
  bool given_ = true;              // false inside a section that is not given
  bool item_begins_ = false;       // the next line is the first of an entry of a list
  bool optional_section_ = false;  // the next section may be left out
  std::string only_with_;          // the choice that has the next key, where the case has made another
  int depth_ = 0;
  std::map<std::string, std::string> short_choices_;  // names of choices, by the list with their meanings
  std::vector<Line> lines_;
};

// A struct described for SectionVisitor, as YAML.
template <typename Section>
std::string written(Section value, YamlStyle style) {
  SectionWriter writer(style);
  describe(writer, value);
  return writer.yaml();
}

// A text in quotation marks, with escapes, as any place in YAML takes it.
std::string yaml_text(const std::string& text);

// A number with as few digits as read back to the same bits.
std::string shortest(double value);

}  // namespace thalweg::io
