// The definition of an enclosed fluid cell, in the plainest words.
#pragma once

#include "core/base/types.hpp"
#include "lbm/lattice/d3q19.hpp"

#include <vector>

namespace thalweg::test {

// is_fluid(cell) says whether there is fluid at a cell, wherever it is.
template <typename IsFluid>
bool is_enclosed_by_definition(const Index3& cell, IsFluid is_fluid) {
  const auto fluid_beside = [&](const Index3& at) {
    std::vector<Index3> found;
    for (int i = 1; i < lbm::D3Q19::directions; ++i) {
      const auto& c = lbm::D3Q19::c[i];
      const Index3 there{at[0] + c[0], at[1] + c[1], at[2] + c[2]};
      if (is_fluid(there)) found.push_back(there);
    }
    return found;
  };
  if (!is_fluid(cell)) return false;
  const std::vector<Index3> others = fluid_beside(cell);
  return others.empty() || (others.size() == 1 && fluid_beside(others[0]).size() == 1);
}

}  // namespace thalweg::test
