// Remedies of one warning that lead to no other: where one would, the remedy of that other is added, and so on.
#pragma once

#include "driver/warnings/remedy.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::driver {

// Looks for one kind of fault in a case.
using WarningRule = Warnings (*)(const Case&);

// The remedies of the warnings of a case, by the rules that it is checked with.
class ConsistentRemedies {
public:
  ConsistentRemedies(const Case& c, std::vector<WarningRule> rules);

  // The warnings of the rules in their order, whole sentences with those of their remedies after which the case is
  // accepted, the warning gone and none of another rule new.
  std::vector<std::string> sentences() const;

  // The first of these remedies; empty: there is none.
  Remedy first() const;

private:
  std::optional<Remedy> useful(const Advice& advice,
                               std::size_t rule) const;  // completed, without what changes nothing
  std::string sentence_of(const Warning& warning, std::size_t rule) const;
  std::optional<Remedy> completed(const Remedy& remedy, std::size_t rule, int rounds) const;

  const Case& case_;
  std::vector<WarningRule> rules_;
  std::vector<Warnings> found_;  // by each rule
};

}  // namespace thalweg::driver
