// Description of the keys of a section, which serves three uses: reading it, writing it back with all defaults, and
// documenting it. For a plain struct T write once
//
//   void describe(SectionVisitor& visit, FluidCase& fluid) {
//     visit.real("density", fluid.density, {.unit = "kg/m^3", .meaning = "mass density", .above = 0.0});
//     ...
//   }
//
// in T's namespace; io::SectionReader and io::SectionWriter are the visitors. The default of a key is the value the
// struct has before it is read; `required` keys and optional values have none. Words of choices: named_choice.hpp.
#pragma once

#include "core/base/check.hpp"
#include "core/base/types.hpp"
#include "core/keys/named_choice.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg {

// A key that belongs to some cases only. Where the condition does not hold, giving the key is an error with this
// reason, which says what to do: "only a navier_slip wall has a slip length; remove it".
struct OnlyIf {
  bool holds = true;
  std::string reason = {};
  std::string with = {};  // the choice that has the key: "collision: trt"; the documentation names it
};

struct RealKey {
  std::string unit = "1";  // "1": none
  std::string meaning = {};
  bool required = false;
  std::optional<double> above = std::nullopt;  // value > above
  std::optional<double> at_least = std::nullopt;
  std::optional<double> below = std::nullopt;  // value < below
  std::optional<double> at_most = std::nullopt;
  std::optional<double> example = std::nullopt;  // shown in errors and, for an optional value, in the documentation
  OnlyIf only_if = {};
  std::vector<double> examples = {};  // of a list, in place of two like `example`
  int fewest_numbers = 3;             // of three: fewer where the last may be left out, as it follows from other keys
};

struct IntegerKey {
  std::string meaning = {};
  bool required = false;
  std::int64_t at_least = 0;
  std::optional<std::int64_t> example = std::nullopt;
  std::optional<std::int64_t> automatic = std::nullopt;  // the value for the word auto; none: not allowed
  OnlyIf only_if = {};
};

struct TextKey {
  std::string meaning = {};
  bool required = false;
  std::string example = {};  // of an optional value, shown in the documentation
  OnlyIf only_if = {};
};

// A word that a choice had in earlier versions, and what to do about a case that gives it: "take grad, ... ".
struct RemovedWord {
  std::string word, remedy;
};

// A section, a list of sections, or a choice.
struct SectionKey {
  std::string meaning = {};
  bool required = false;
  std::string shorthand = {};   // a plain word in place of the section is the value of this key: x: no_slip
  bool in_full = false;         // with shorthand: the documentation shows the section, with the keys of other choices
  std::string expected = {};    // with shorthand: what is given in most cases, for complaints: "a number in m"
  std::string empty_name = {};  // this word in place of the section stands for the section without keys: fluid: rest
  std::vector<RemovedWord> removed = {};  // of a choice: reading one is an error that gives its remedy
  OnlyIf only_if = {};
};

class SectionVisitor {
public:
  virtual ~SectionVisitor() = default;

  // Values: double, Vec3, std::int64_t or std::string, or an optional of them; bool; lists of double, of Vec3 or of
  // whole numbers.
  void real(const std::string& key, auto& value, const RealKey& about) { visit(key, value, about); }
  void vec3(const std::string& key, auto& value, const RealKey& about) { visit(key, value, about); }
  void vec3_list(const std::string& key, std::vector<Vec3>& values, const RealKey& about) { visit(key, values, about); }
  void real_list(const std::string& key, std::vector<double>& values, const RealKey& about) {
    visit(key, values, about);
  }
  void integer(const std::string& key, auto& value, const IntegerKey& about) { visit(key, value, about); }
  void integer_list(const std::string& key, std::vector<std::int64_t>& values, const IntegerKey& about) {
    visit(key, values, about);
  }
  void text(const std::string& key, auto& value, const TextKey& about) { visit(key, value, about); }
  void flag(const std::string& key, bool& value, const TextKey& about) { visit(key, value, about); }

  template <typename Choice>
  void choice(const std::string& key, Choice& value, const std::vector<NamedChoice<Choice>>& choices,
              const SectionKey& about) {
    if (!belongs(key, about.only_if)) return;
    std::size_t index = index_of(value, choices);
    word(key, index, words_of(choices), about);
    value = choices[index].value;
  }

  // The words are those of the enumeration, choices_of().
  template <typename Choice>
  void choice(const std::string& key, Choice& value, const SectionKey& about) {
    choice(key, value, choices_of(value), about);
  }

  // Empty: not given.
  template <typename Choice>
  void choice(const std::string& key, std::optional<Choice>& value, const std::vector<NamedChoice<Choice>>& choices,
              const SectionKey& about) {
    if (!belongs(key, about.only_if)) return;
    std::optional<std::size_t> index;
    if (value) index = index_of(*value, choices);
    word(key, index, words_of(choices), about);
    value.reset();
    if (index) value = choices[*index].value;
  }

  template <typename Choice>
  void choice_list(const std::string& key, std::vector<Choice>& values, const std::vector<NamedChoice<Choice>>& choices,
                   const SectionKey& about) {
    if (!belongs(key, about.only_if)) return;
    std::vector<std::size_t> indices;
    for (const Choice& value : values) indices.push_back(index_of(value, choices));
    word_list(key, indices, words_of(choices), about);
    values.clear();
    for (std::size_t index : indices) values.push_back(choices[index].value);
  }

  // Contents of a section that depends on other sections, for which a struct and its describe() do not suffice.
  using Body = std::function<void(SectionVisitor&)>;
  void section(const std::string& key, const SectionKey& about, const Body& body) {
    if (belongs(key, about.only_if)) nested(key, true, about, body);
  }

  template <typename Section>
  void section(const std::string& key, Section& value, const SectionKey& about) {
    section(key, about, Body([&](SectionVisitor& inside) { describe(inside, value); }));
  }

  // Empty: the section is not given.
  template <typename Section>
  void section(const std::string& key, std::optional<Section>& value, const SectionKey& about) {
    if (!belongs(key, about.only_if)) return;
    const bool given = is_given(key, value.has_value());
    Section held = value.value_or(Section{});
    nested(key, given, about, [&](SectionVisitor& inside) { describe(inside, held); });
    if (given)
      value = held;
    else
      value.reset();
  }

  template <typename Section>
  void list(const std::string& key, std::vector<Section>& values, const SectionKey& about) {
    if (!belongs(key, about.only_if)) return;
    const std::size_t size = begin_list(key, values.size(), about);
    values.resize(size);
    for (std::size_t n = 0; n < size; ++n) item(key, n, [&](SectionVisitor& inside) { describe(inside, values[n]); });
    if (size > 0) return;
    Section example{};
    example_item([&](SectionVisitor& inside) { describe(inside, example); });
  }

  // The key belongs to this section but not to this case; reading it is an error that gives the reason.
  virtual void not_here(const std::string& key, const std::string& reason) = 0;

  // A condition between values just visited; where it does not hold, reading fails with the place and value of the key
  // and this remedy.
  virtual void require(bool condition, const std::string& key, const std::string& remedy) = 0;

  // True if values are being filled in, false if they are being shown.
  virtual bool reading() const = 0;

protected:
  virtual void value_of(const std::string& key, double& value, const RealKey& about) = 0;
  virtual void value_of(const std::string& key, std::optional<double>& value, const RealKey& about) = 0;
  virtual void value_of(const std::string& key, Vec3& value, const RealKey& about) = 0;
  virtual void value_of(const std::string& key, std::optional<Vec3>& value, const RealKey& about) = 0;
  virtual void value_of(const std::string& key, std::vector<Vec3>& values, const RealKey& about) = 0;
  virtual void value_of(const std::string& key, std::int64_t& value, const IntegerKey& about) = 0;
  virtual void value_of(const std::string& key, std::optional<std::int64_t>& value, const IntegerKey& about) = 0;
  virtual void value_of(const std::string& key, std::vector<std::int64_t>& values, const IntegerKey& about) = 0;
  virtual void value_of(const std::string& key, std::vector<double>& values, const RealKey& about) = 0;
  virtual void value_of(const std::string& key, std::string& value, const TextKey& about) = 0;
  virtual void value_of(const std::string& key, std::optional<std::string>& value, const TextKey& about) = 0;
  virtual void value_of(const std::string& key, bool& value, const TextKey& about) = 0;

  struct Word {
    std::string name, meaning;
  };

  virtual void word(const std::string& key, std::size_t& index, const std::vector<Word>& words,
                    const SectionKey& about) = 0;
  virtual void word(const std::string& key, std::optional<std::size_t>& index, const std::vector<Word>& words,
                    const SectionKey& about) = 0;
  virtual void word_list(const std::string& key, std::vector<std::size_t>& indices, const std::vector<Word>& words,
                         const SectionKey& about) = 0;
  virtual bool is_given(const std::string& key, bool has_value) = 0;
  virtual void nested(const std::string& key, bool given, const SectionKey& about, const Body& body) = 0;
  virtual std::size_t begin_list(const std::string& key, std::size_t size, const SectionKey& about) = 0;
  virtual void item(const std::string& key, std::size_t index, const Body& body) = 0;
  virtual void example_item(const Body&) {}  // of a list that is empty

  // True if the next key is visited although only another choice has it.
  virtual bool shows_key_with(const std::string&) { return false; }

private:
  bool belongs(const std::string& key, const OnlyIf& only_if) {
    if (only_if.holds || (!only_if.with.empty() && shows_key_with(only_if.with))) return true;
    not_here(key, only_if.reason);
    return false;
  }
  void visit(const std::string& key, auto& value, const auto& about) {
    if (belongs(key, about.only_if)) value_of(key, value, about);
  }
  template <typename Choice>
  static std::size_t index_of(const Choice& value, const std::vector<NamedChoice<Choice>>& choices) {
    std::size_t index = 0;
    while (index < choices.size() && choices[index].value != value) ++index;
    CHECK(index < choices.size());  // the value has a word
    return index;
  }
  template <typename Choice>
  static std::vector<Word> words_of(const std::vector<NamedChoice<Choice>>& choices) {
    std::vector<Word> words;
    for (const auto& choice : choices) words.push_back({choice.name, choice.meaning});
    return words;
  }
};

}  // namespace thalweg
