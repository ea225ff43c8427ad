// Contracts between parts of the program. CHECK is always on, also in release builds; it stands at the seams of
// modules, not in loops over cells, links or populations.
#pragma once

#include <stdexcept>
#include <string>

namespace thalweg {

// A contract is broken: the program is wrong, not its input. A run ends with exit code 1, like every failure that is
// not the user's.
class ContractError : public std::logic_error {
public:
  using std::logic_error::logic_error;
};

// Throws ContractError with the condition, its file and line.
[[noreturn, gnu::cold, gnu::noinline]] inline void report_broken_contract(const char* condition, const char* file,
                                                                          int line) {
  throw ContractError("The program contradicts itself: \"" + std::string(condition) + "\" does not hold at " + file +
                      ":" + std::to_string(line) + ". Please report this with the case file.");
}

}  // namespace thalweg

#ifdef __FILE_NAME__
#define THALWEG_FILE __FILE_NAME__
#else
#define THALWEG_FILE __FILE__
#endif

// Throws ContractError unless the condition holds.
#define CHECK(condition) ((condition) ? void() : ::thalweg::report_broken_contract(#condition, THALWEG_FILE, __LINE__))
