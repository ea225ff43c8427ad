// Links whose upstream cell x_ff = x_f - c_i a body covers: x_f is a gap of one cell between that body and the one the
// link runs into. A batch of them, with what stands in for f_i^c(x_ff). Symbols as in interpolated_bounce_back.hpp.
#pragma once

#include "bodies/map/link_table.hpp"
#include "core/base/check.hpp"

#include <cstdint>

namespace thalweg::bodies {

// Arrays of doubles, whatever the precision of the populations: the arithmetic is the same for every link whatever its
// place in the batch.
class UpstreamBodies {
public:
  static constexpr int capacity = 128;  // whole vectors of links, links_at_a_time each

  void begin(int count) {
    CHECK(count <= capacity);
    count_ = count;
  }

  // A link: delta, its crossing from the centre of the body that covers x_ff, rho - 1 at x_f, and this body. Cells.
  void take(int link, std::uint32_t tag, double distance, const Vec3& arm, double deviation, const LinkBody& other) {
    tag_[link] = tag;
    distance_[link] = distance;
    deviation_[link] = deviation;
    for (int a = 0; a < 3; ++a) {
      arm_[a][link] = arm[a];
      velocity_[a][link] = other.velocity[a];
      spin_[a][link] = other.angular_velocity[a];
    }
  }

  // The equilibrium at x_ff: density as at x_f, velocity that of the covering body. With the hydrostatic gradient 3 F
  // of a force F the density is that one cell further on, and 3/2 w_i c_i.F, its half force, is added.
  void find_populations(const Vec3& rest_gradient);

  double population(int link) const { return population_[link]; }  // in place of f_i^c(x_ff)

private:
  int count_ = 0;
  std::uint32_t tag_[capacity] = {};
  alignas(64) double distance_[capacity] = {}, arm_[3][capacity] = {};      // arm: the crossing from the other's centre
  alignas(64) double velocity_[3][capacity] = {}, spin_[3][capacity] = {};  // of the other
  alignas(64) double deviation_[capacity] = {}, population_[capacity] = {};
};

}  // namespace thalweg::bodies
