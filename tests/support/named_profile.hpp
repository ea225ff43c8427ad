// Profiles of observers and systems by name.
#pragma once

#include "core/state/profile.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace thalweg::test {

// Throws std::out_of_range where there is none of this name.
inline const Profile& named(const std::vector<Profile>& profiles, const std::string& name) {
  for (const Profile& profile : profiles)
    if (profile.name == name) return profile;
  throw std::out_of_range("no profile " + name);
}

}  // namespace thalweg::test
