// How tests of messages look for words in them.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace thalweg::driver {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&](const std::string& text) { return contains(text, part); });
}

}  // namespace thalweg::driver
