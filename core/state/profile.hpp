// A measured array with its unit: what an observer reports besides single diagnostics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg {

struct Profile {
  std::string name;                     // e.g. "reynolds_stress"
  std::string unit;                     // e.g. "m^2/s^2", "1" for none
  std::vector<std::string> axes;        // names of the dimensions but for that of components: the profile, if there is
                                        // one, with the places along it ({"z"}), else what it counts ({"point"})
  std::vector<std::string> components;  // names along the last dimension; empty where it is not one of components
  std::vector<std::uint64_t> shape;     // slowest first
  std::vector<double> values;
};

}  // namespace thalweg
