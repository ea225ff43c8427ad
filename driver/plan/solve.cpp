#include "driver/plan/solve.hpp"

#include "core/base/shell_word.hpp"
#include "driver/warnings/case_warnings.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

namespace {

constexpr int most_rounds_of_solving = 20;  // each takes one warning away and brings none

}  // namespace

Solution solve(const Case& c) {
  Solution solution;
  Case now = c;
  for (int round = 0; round < most_rounds_of_solving; ++round) {
    const Remedy next = first_remedy(now);
    if (next.empty()) break;
    solution.changes = joined(solution.changes, next);
    now = changed(now, next);
  }
  solution.left = warnings(now);
  return solution;
}

std::vector<std::string> solution_report(const Case& c, const std::string& path,
                                         const std::vector<std::string>& settings) {
  const Solution solution = solve(c);
  std::vector<std::string> lines;
  for (const Change& change : solution.changes)
    lines.push_back(fmt::format("{:<10} {}: {}", lines.empty() ? "change" : "", change.key, change.value));
  if (!solution.changes.empty()) {
    std::string command = "thalweg check " + shell_word(path);
    for (const std::string& setting : settings) command += " --set " + shell_word(setting);
    for (const Change& change : solution.changes)
      command += " --set " + shell_word(fmt::format("{}={}", change.key, change.value));
    lines.push_back("to try     " + command);
  }
  for (const std::string& warning : solution.left) lines.push_back("warning    " + warning);
  if (lines.empty()) lines.emplace_back("change     nothing: the case has no warning");
  return lines;
}

}  // namespace thalweg::driver
