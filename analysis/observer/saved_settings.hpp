// Settings that the sums of an observer depend on, saved with them.
#pragma once

#include "core/base/archive.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::analysis {

using SavedSettings = std::vector<std::pair<std::string, double>>;  // by name

// Into the group of the observer.
inline void save_settings(ArchiveWriter& archive, const std::string& group, const SavedSettings& settings) {
  const std::string in_group = group + "/";
  for (const auto& [name, value] : settings) archive.attribute(in_group + name, value);
}

// True if the sums of that group were made with these settings. An archive that lacks a setting is older than it, and
// is accepted.
inline bool were_saved_with(const ArchiveReader& archive, const std::string& group, const SavedSettings& settings) {
  const std::string in_group = group + "/";
  return std::all_of(settings.begin(), settings.end(), [&](const auto& setting) {
    const std::string path = in_group + setting.first;
    return !archive.has(path) || archive.real_attribute(path) == setting.second;
  });
}

}  // namespace thalweg::analysis
