#include "driver/warnings/consistent_remedy.hpp"

#include "core/base/error.hpp"
#include "driver/input/case_checks.hpp"

#include <algorithm>

namespace thalweg::driver {

namespace {

constexpr int most_rounds = 4;  // of remedies added to one

bool is_accepted(const Case& c) {
  try {
    check_case(c, io::YamlDocument());
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// True if the remedy includes all changes of the other.
bool has_all(const Remedy& remedy, const Remedy& other) {
  return std::all_of(other.begin(), other.end(), [&](const Change& change) {
    return std::any_of(remedy.begin(), remedy.end(), [&](const Change& own) { return own.key == change.key; });
  });
}

}  // namespace

ConsistentRemedies::ConsistentRemedies(const Case& c, std::vector<WarningRule> rules)
    : case_(c), rules_(std::move(rules)) {
  for (const WarningRule rule : rules_) found_.push_back(rule(c));
}

std::vector<std::string> ConsistentRemedies::sentences() const {
  std::vector<std::string> sentences;
  for (std::size_t rule = 0; rule < rules_.size(); ++rule)
    for (const Warning& warning : found_[rule]) sentences.push_back(sentence_of(warning, rule));
  return sentences;
}

Remedy ConsistentRemedies::first() const {
  for (std::size_t rule = 0; rule < rules_.size(); ++rule)
    for (const Warning& warning : found_[rule])
      for (const Advice& advice : warning.advice)
        if (std::optional<Remedy> remedy = useful(advice, rule)) return *remedy;
  return {};
}

std::string ConsistentRemedies::sentence_of(const Warning& warning, std::size_t rule) const {
  if (warning.advice.empty() && warning.otherwise.empty()) return warning.sentence;
  std::string remedies;
  std::vector<Remedy> said;
  for (const Advice& advice : warning.advice) {
    const std::optional<Remedy> remedy = useful(advice, rule);
    if (!remedy || std::any_of(said.begin(), said.end(), [&](const Remedy& one) { return has_all(*remedy, one); }))
      continue;
    const std::string verb = remedies.empty() && advice.lead.empty() ? "consider " : advice.lead;
    remedies += (remedies.empty() ? "" : ", or ") + verb + text_of(*remedy);
    said.push_back(*remedy);
  }
  if (remedies.empty() && !warning.otherwise.empty()) remedies = "consider " + warning.otherwise;
  return warning.sentence + (remedies.empty() ? "" : ": " + remedies) + ".";
}

std::optional<Remedy> ConsistentRemedies::useful(const Advice& advice, std::size_t rule) const {
  std::optional<Remedy> remedy = completed(advice.remedy, rule, most_rounds);
  if (remedy) std::erase_if(*remedy, [&](const Change& change) { return changed(case_, {change}) == case_; });
  return remedy;
}

std::optional<Remedy> ConsistentRemedies::completed(const Remedy& remedy, std::size_t rule, int rounds) const {
  const Remedy whole = with_grain_steps(case_, remedy);
  const Case after = changed(case_, whole);
  if (!is_accepted(after)) return std::nullopt;
  for (std::size_t other = 0; other < rules_.size(); ++other) {
    const Warnings left = rules_[other](after);
    const std::size_t fewer = other == rule ? 1 : 0;
    if (left.size() + fewer <= found_[other].size()) continue;
    if (rounds == 0) return std::nullopt;
    for (const Warning& warning : left)
      for (const Advice& advice : warning.advice)
        if (const std::optional<Remedy> more = completed(joined(remedy, advice.remedy), rule, rounds - 1)) return more;
    return std::nullopt;
  }
  return whole;
}

}  // namespace thalweg::driver
