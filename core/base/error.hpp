// The two ways a run can fail. Besides these, ContractError (check.hpp) reports a fault of the program, and KeyError
// (core/keys/key_error.hpp) becomes an InputError before it reaches the user.
//
// A message is one or more whole sentences: what is wrong, where, and what would be right.
#pragma once

#include <stdexcept>

namespace thalweg {

// The user's input cannot be run. The program ends with exit code 2 and has written nothing.
class InputError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

// A run that was going has gone wrong (a grain left the domain, the fluid became unstable, the disk is full).
// The program ends with exit code 1 and keeps the last good checkpoint.
class RunError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace thalweg
