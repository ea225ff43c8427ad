#include "driver/estimate/stability.hpp"

namespace thalweg::driver {

double stable_lattice_velocity(lbm::CollisionModel collision, double excess) {
  struct Row {
    double excess, bgk, trt;
  };
  constexpr Row map[] = {{5e-2, 0.15, 0.15}, {3e-2, 0.15, 0.15}, {2e-2, 0.15, 0.15},
                         {1e-2, 0.15, 0.10}, {3e-3, 0.05, 0.02}, {1e-3, 0.02, 0.0}};
  for (const Row& row : map) {
    if (excess < row.excess) continue;
    return lbm::bgk_in_the_open(collision) ? row.bgk : row.trt;
  }
  return 0.0;
}

}  // namespace thalweg::driver
