// A value of the user's that cannot be run, named by its key. Whoever read the keys adds file, line and value and
// throws InputError (core/error.hpp).
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace thalweg {

struct KeyError : std::runtime_error {
  // key: from the section that was checked on, "points.0"; empty: the section itself. remedy: "... ; give ...".
  KeyError(std::string key_path, const std::string& remedy) : std::runtime_error(remedy), key(std::move(key_path)) {}
  std::string key;
};

}  // namespace thalweg
