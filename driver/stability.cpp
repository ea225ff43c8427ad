#include "driver/stability.hpp"

namespace thalweg::driver {

double stable_lattice_velocity(lbm::CollisionModel collision, double excess) {
  struct Row {
    double excess, bgk, trt, regularised;
  };
  constexpr Row map[] = {{5e-2, 0.15, 0.15, 0.15}, {3e-2, 0.15, 0.15, 0.05}, {2e-2, 0.15, 0.15, 0.02},
                         {1e-2, 0.15, 0.10, 0.02}, {3e-3, 0.05, 0.02, 0.0},  {1e-3, 0.02, 0.0, 0.0}};
  for (const Row& row : map) {
    if (excess < row.excess) continue;
    return lbm::bgk_in_the_open(collision)         ? row.bgk
           : collision == lbm::CollisionModel::trt ? row.trt
                                                   : row.regularised;
  }
  return 0.0;
}

}  // namespace thalweg::driver
