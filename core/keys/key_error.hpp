// An unusable value in the user's case, named by its key. The reader of the keys adds file, line and value and throws
// InputError (core/base/error.hpp).
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace thalweg {

struct KeyError : std::runtime_error {
  // key: relative to the section checked, e.g. "points.0"; empty: the section itself. remedy: "... ; give ...".
  KeyError(std::string key_path, const std::string& remedy) : std::runtime_error(remedy), key(std::move(key_path)) {}
  std::string key;
};

}  // namespace thalweg
