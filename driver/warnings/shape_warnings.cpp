#include "driver/warnings/shape_warnings.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

// A clump has the volume of its surface because its spheres grow: where they held less than half of it before, they
// stand far out of it, and the grain is of another shape. A cube of 20 spheres has 80 %, an L of two cubes 76 %, a
// plate of 1 : 1 : 0.05 has 3 %.
Warnings unlike_clumps(const Case& c) {
  constexpr double least = 0.5;
  Warnings found;
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (const auto& shape = c.grains[n].shape; shape && shape->inscribed < least)
      found.push_back(fmt::format(
          "The {} spheres of grains.{}.shape hold only {:.2g} % of the surface's volume before they grow to all of it, "
          "so that the clump has another shape: give more spheres, and see with thalweg clump how near they come.",
          shape->clump.size(), n, 100.0 * shape->inscribed));
  return found;
}

}  // namespace thalweg::driver
