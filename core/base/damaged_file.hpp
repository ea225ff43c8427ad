// The failure of a file that is no longer what was written.
#pragma once

#include "core/base/error.hpp"

namespace thalweg {

// The file was cut short, or bits of it have changed. A file that was merely written for another case is an InputError.
class DamagedFile : public InputError {
public:
  using InputError::InputError;
};

}  // namespace thalweg
