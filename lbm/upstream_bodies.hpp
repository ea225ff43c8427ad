// Links whose upstream cell x_ff = x_f - c_i a body covers: x_f is a gap of one cell between that body and the one the
// link runs into. A batch of them, with what stands in for f_i^c(x_ff), and the slip of such gaps. Symbols as in
// link_pass.hpp.
//
// Slip: between half-link walls one cell apart, bounce-back lets a force F drive u = 2/3 Lambda F/nu, Lambda = (tau+ -
// 1/2)(tau- - 1/2) (Ginzburg and d'Humieres 2003). The true velocity is F/(8 nu); in water under bgk Lambda is 1e-7 to
// 1e-5, so that such gaps are plugged: fluid that a grain should squeeze out before it touches another stays and is
// compressed. The cause is the odd part o = (f_i^c - f_i'^c)/2 of links with a wall at both ends, which changes sign in
// every step and carries off the momentum of the other directions. It becomes
//   o -> theta o + (1 - theta) [3 w_i rho c_i.(u_m + v) + 3/2 w_i c_i.F],   u_m = (u_1 + u_2)/2,
// before such a link is bounced back half-way, whatever its delta, from a wall with the velocity u_w + v;
//   v = s (1 - m m)(u - u_m),   m = (n_1 - n_2)/|n_1 - n_2|
// is a share of the velocity along the gap relative to its walls, with u_1, u_2 the velocities and n_1, n_2 the normals
// of both bodies at x_f. The links then return u_m + v, the mean of both walls plus the slip; a rule that interpolates
// with delta would return another mean, and walls that slide past each other would drive the fluid. The term with F is
// the half force that f^c contains. With it a gap that is closed at its ends is at rest with the pressure gradient F;
// without it the gradient would be F (1 + omega'/4), and a pressure would drive that much less.
//
// Between flat walls the balance of momentum, F = loss to the walls, gives u = F/(8 nu) for
//   theta = 0, s = 1 - 1/K                    where K = omega'/(16 nu) is above 1,
//   theta = (1 - K)/(K - 1 + omega'), s = 0   below,
// omega' the rate of the odd part. theta reaches 1, plain bounce-back, at Lambda = 3/16; from there on the link's own
// rule remains. Momentum along the gap then stays in the fluid until viscosity removes it. Both ends of a link get the
// same change, so that no mass is made; momentum goes to the bodies as in any link.
//
// In a cell that is a pocket, or enclosed (Confinement), s = 0. Nothing can flow through it along the gap, and no fluid
// beside it takes momentum along v from it: with v only viscosity would slow it down, over hundreds of steps, while the
// links of moving grains and the Reynolds stress in the cell drive it. In a flume such water reached twice the speed of
// the stream above the bed.
#pragma once

#include "lbm/collision.hpp"
#include "lbm/link_table.hpp"

#include <cstdint>

namespace thalweg::lbm {

// theta and s above.
struct GapFlow {
  double kept = 1.0;  // theta
  double slip = 0.0;  // s
};
// nu and omega' are those without eddies. theta is exactly 1 from Lambda = 3/16 on.
GapFlow gap_flow(const CollisionParameters& collision);

// Arrays of doubles, whatever the precision of the populations: the arithmetic is the same for every link whatever its
// place in the batch.
//
// With gaps that flow a link also has what the fluid does at x_f, and the normals of both bodies.
class UpstreamBodies {
public:
  static constexpr int capacity = 128;  // whole vectors of links, links_at_a_time each

  int count() const { return count_; }

  void begin(int count) { count_ = count; }

  // A link: delta, its crossing from the own body's centre, and rho - 1 at x_f; the body that covers x_ff, and the
  // vector from its centre to that of the own body. Cells.
  void take(int link, std::uint32_t tag, double distance, const Vec3& arm, double deviation, const LinkBody& other,
            const Vec3& apart) {
    tag_[link] = tag;
    distance_[link] = distance;
    deviation_[link] = deviation;
    for (int a = 0; a < 3; ++a) {
      own_arm_[a][link] = arm[a];
      arm_[a][link] = apart[a] + arm[a];
      velocity_[a][link] = other.velocity[a];
      spin_[a][link] = other.angular_velocity[a];
    }
  }

  // own: the body that the link runs into; momentum: sum c_i f_i^c at x_f; odd: o there.
  void set_flow(int link, const LinkBody& own, const Vec3& momentum, double odd) {
    for (int a = 0; a < 3; ++a) {
      own_velocity_[a][link] = own.velocity[a];
      own_spin_[a][link] = own.angular_velocity[a];
      momentum_[a][link] = momentum[a];
    }
    odd_[link] = odd;
  }

  // x_f of a link from the centres of the own body and of the other, and the outward normals of both there, of any
  // length.
  Vec3 from_own(int link) const { return before_arm(own_arm_, link); }
  Vec3 from_other(int link) const { return before_arm(arm_, link); }
  void set_normals(int link, const Vec3& own, const Vec3& other);
  void set_radial_normals();  // of all links, between spheres

  // Lets the fluid flow between the own bodies and those behind. force: its density; f^c contains half of it too much.
  void let_flow(const double (&force)[3], const GapFlow& flow);

  // The equilibrium at x_ff: density as at x_f, velocity that of the covering body. With the hydrostatic gradient 3 F
  // of a force F the density is that one cell further on, and 3/2 w_i c_i.F, its half force, is added.
  void find_populations(const Vec3& rest_gradient);

  double population(int link) const { return population_[link]; }  // in place of f_i^c(x_ff)
  double slip_along(int link) const { return slip_along_[link]; }  // c_i . v
  double odd_change(int link) const { return odd_change_[link]; }  // of o

private:
  Vec3 before_arm(const double (&arm)[3][capacity], int link) const {
    Vec3 from;
    for (int a = 0; a < 3; ++a)
      from[a] = arm[a][link] - distance_[link] * LinkTag::velocity(static_cast<int>(tag_[link]), a);
    return from;
  }

  int count_ = 0;
  std::uint32_t tag_[capacity] = {};
  // The crossing from both centres, the other's place and motion, and where the fluid flows the own body's motion.
  alignas(64) double distance_[capacity] = {}, own_arm_[3][capacity] = {}, arm_[3][capacity] = {};
  alignas(64) double velocity_[3][capacity] = {}, spin_[3][capacity] = {};
  alignas(64) double own_velocity_[3][capacity] = {}, own_spin_[3][capacity] = {};
  alignas(64) double deviation_[capacity] = {}, momentum_[3][capacity] = {}, odd_[capacity] = {};
  alignas(64) double own_normal_[3][capacity] = {}, normal_[3][capacity] = {};
  alignas(64) double slip_along_[capacity] = {}, odd_change_[capacity] = {}, population_[capacity] = {};
};

}  // namespace thalweg::lbm
