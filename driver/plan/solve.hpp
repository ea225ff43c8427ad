// `thalweg check --solve`: the few keys of a case to change so that no warning is left.
#pragma once

#include "driver/warnings/remedy.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

struct Solution {
  Remedy changes;                 // together; empty: nothing needs to be changed
  std::vector<std::string> left;  // warnings that no change of a number mends, of the case as changed
};

// Takes the first remedy of the first warning that has one, as it keeps the rest of the case consistent, until none is
// left.
Solution solve(const Case& c);

// Lines that say so, with the changes as options to paste behind those that the case was read with (KEY=VALUE).
std::vector<std::string> solution_report(const Case& c, const std::string& path,
                                         const std::vector<std::string>& settings);

}  // namespace thalweg::driver
