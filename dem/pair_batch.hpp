// Pairs of grains in contact, many at once: gathered into arrays, so that the contact law is evaluated for several in
// one instruction, and scattered in their order.
//
// A pair that does not touch goes along with a force of zero: nearly all touch, and adding zero changes no bit (no sum
// here is ever -0, since it began at +0).
#pragma once

#include "core/periodic_box.hpp"
#include "dem/contact_law.hpp"
#include "dem/contact_list.hpp"
#include "dem/material.hpp"
#include "dem/minimum_image.hpp"
#include "dem/moving_grains.hpp"
#include "dem/rolling_friction.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace thalweg::dem {

inline Row last_everywhere(const Row& r) { return Row{r[3], r[3], r[3], r[3]}; }

inline Row row_at(const double* values) {
  Row row;
  std::memcpy(&row, values, sizeof(Row));
  return row;
}

// Turns four rows into four columns, and back.
inline void transpose(Row (&r)[4]) {
  const Row a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Row c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

// rolling: whether the pairs have rolling friction (ContactList::rolling_pairs).
template <bool rolling>
class PairBatch {
public:
  static constexpr int capacity = 64;
  static constexpr int lanes = 8;  // whole vectors: the last one is filled up with copies of the first pair

  // material: of every slot.
  PairBatch(MovingGrains& grains, ContactList& list, const PeriodicBox& box, const MaterialTable& materials,
            std::span<const std::uint8_t> material)
      : grains_(grains),
        pairs_(list.pairs),
        rolling_pairs_(list.rolling_pairs),
        image_(box),
        materials_(materials),
        material_(material) {
    static_assert(offsetof(PairContact, damping) == offsetof(PairContact, spring) + 3 * sizeof(double));
    static_assert(offsetof(RollingContact, friction) == offsetof(RollingContact, spring) + 3 * sizeof(double));
    // One material's numbers are the same in all lanes, so they are put there once.
    if (materials.count() > 1) return;
    const ContactCoefficients& only = materials.pair(0, 0).coefficients;
    std::fill_n(normal_, capacity, only.normal);
    std::fill_n(tangential_, capacity, only.tangential);
    std::fill_n(friction_, capacity, only.friction);
  }

  // near: at most `capacity`. fetch: whether to ask for grains and contacts of `ahead` pairs behind these.
  template <bool fetch, typename ContactLaw>
  void evaluate(std::span<const NearPair> near, std::span<const NearPair> behind, const ContactLaw& law) {
    const int count = static_cast<int>(near.size()), rounded = (count + lanes - 1) / lanes * lanes;
    std::copy(near.begin(), near.end(), pair_);
    std::fill(pair_ + count, pair_ + rounded, near[0]);
    for (int k = 0; k < rounded; k += 4) {
      if constexpr (fetch)
        for (std::size_t n = k; n < std::min<std::size_t>(k + 4, behind.size()); ++n) ask_for(behind[n]);
      gather(k);
    }
    if (materials_.count() > 1) gather_coefficients(rounded);
    evaluate(law, rounded);
    for (int k = 0; k < count; k += 4) scatter(k, std::min(4, count - k));
  }

private:
  using Lane = double[capacity];

  static void store(const Row (&r)[4], int k, Lane& x, Lane& y, Lane& z, Lane& last) {
    std::memcpy(x + k, &r[0], sizeof(Row));
    std::memcpy(y + k, &r[1], sizeof(Row));
    std::memcpy(z + k, &r[2], sizeof(Row));
    std::memcpy(last + k, &r[3], sizeof(Row));
  }

  // Inlined, because to the compiler a function that only asks does nothing, and a call of it can go.
  [[gnu::always_inline]] void ask_for(const NearPair& next) const {
    __builtin_prefetch(&pairs_[next.pair], 1);
    if constexpr (rolling) __builtin_prefetch(&rolling_pairs_[next.pair], 1);
    for (const std::uint32_t slot : {next.first, next.second}) {
      const char* grain = reinterpret_cast<const char*>(&grains_[slot]);
      for (std::size_t line = 0; line < sizeof(MovingGrain); line += 64) __builtin_prefetch(grain + line, 1);
    }
  }

  void gather(int k) {
    Row separation[4], v[4], rw[4], w[4], spring[4];
    for (int m = 0; m < 4; ++m) {
      const PairContact& c = pairs_[pair_[k + m].pair];
      const MovingGrain &first = grains_[pair_[k + m].first], &second = grains_[pair_[k + m].second];
      separation[m] = image_(first.position - second.position);
      v[m] = first.velocity - second.velocity;
      rw[m] = last_everywhere(first.position) * first.spin + last_everywhere(second.position) * second.spin;
      w[m] = first.spin + second.spin;
      spring[m] = row_at(c.spring);
      reach_[k + m] = c.reach;
    }
    transpose(separation), transpose(v), transpose(rw), transpose(w), transpose(spring);
    store(separation, k, x_, y_, z_, difference_);
    store(v, k, vx_, vy_, vz_, unused_);
    store(rw, k, rwx_, rwy_, rwz_, unused_);
    store(w, k, wx_, wy_, wz_, unused_);
    store(spring, k, sx_, sy_, sz_, damping_);
    if constexpr (rolling) gather_rolling(k);
  }

  void gather_rolling(int k) {
    Row spin[4], spring[4];
    for (int m = 0; m < 4; ++m) {
      const RollingContact& c = rolling_pairs_[pair_[k + m].pair];
      spin[m] = grains_[pair_[k + m].first].spin - grains_[pair_[k + m].second].spin;
      spring[m] = row_at(c.spring);
      roll_.inertia[k + m] = c.inertia;
    }
    transpose(spin), transpose(spring);
    store(spin, k, roll_.wx, roll_.wy, roll_.wz, unused_);
    store(spring, k, roll_.sx, roll_.sy, roll_.sz, roll_.friction);
  }

  void gather_coefficients(int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const ContactCoefficients& pair =
          materials_.pair(material_[pair_[k].first], material_[pair_[k].second]).coefficients;
      normal_[k] = pair.normal, tangential_[k] = pair.tangential, friction_[k] = pair.friction;
    }
  }

  // Force on the first and turning moment per unit of lever arm on both: n x F_t, with the sign turned.
  template <typename ContactLaw>
  void evaluate(const ContactLaw& law, int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const double squared = x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k];
      const bool touches = squared < reach_[k] * reach_[k];
      const double distance = std::sqrt(squared);
      const double inverse = 1.0 / distance, nx = inverse * x_[k], ny = inverse * y_[k], nz = inverse * z_[k];
      const double overlap = reach_[k] - distance, half = 0.5 * overlap;
      // Surface velocity by rotation: -(l1 w1 + l2 w2) x n with the lever arms l = R - overlap/2.
      const double ax = rwx_[k] - half * wx_[k], ay = rwy_[k] - half * wy_[k], az = rwz_[k] - half * wz_[k];
      const ContactMotion motion{overlap, nx, ny, nz, vx_[k] - (ay * nz - az * ny), vy_[k] - (az * nx - ax * nz),
                                 vz_[k] - (ax * ny - ay * nx),
                                 // R1 R2/(R1 + R2) of the sum and the difference of the radii
                                 0.25 * (reach_[k] - difference_[k] * difference_[k] / reach_[k])};
      const ContactCoefficients coefficients{normal_[k], tangential_[k], friction_[k]};
      const ContactForce f = law(motion, coefficients, damping_[k], {sx_[k], sy_[k], sz_[k]});
      const auto if_touching = [touches](double value) { return touches ? value : 0.0; };
      if constexpr (rolling) {
        const RollingMoment m = rolling_moment(
            motion, roll_.wx[k], roll_.wy[k], roll_.wz[k], f.normal, law.normal_spring(motion, coefficients),
            {roll_.friction[k], rolling_damping_, roll_.inertia[k]}, {roll_.sx[k], roll_.sy[k], roll_.sz[k]});
        roll_.wx[k] = if_touching(m.x), roll_.wy[k] = if_touching(m.y), roll_.wz[k] = if_touching(m.z);
        roll_.sx[k] = if_touching(m.spring.x), roll_.sy[k] = if_touching(m.spring.y);
        roll_.sz[k] = if_touching(m.spring.z);
      }
      x_[k] = if_touching(f.normal * nx + f.tx);
      y_[k] = if_touching(f.normal * ny + f.ty);
      z_[k] = if_touching(f.normal * nz + f.tz);
      wx_[k] = if_touching(f.ty * nz - f.tz * ny);
      wy_[k] = if_touching(f.tz * nx - f.tx * nz);
      wz_[k] = if_touching(f.tx * ny - f.ty * nx);
      sx_[k] = if_touching(f.spring.x), sy_[k] = if_touching(f.spring.y), sz_[k] = if_touching(f.spring.z);
      difference_[k] = half;
    }
  }

  void take_moments(int k, Row (&moment)[4], Row (&spring)[4]) const {
    moment[0] = row_at(roll_.wx + k), moment[1] = row_at(roll_.wy + k), moment[2] = row_at(roll_.wz + k);
    spring[0] = row_at(roll_.sx + k), spring[1] = row_at(roll_.sy + k), spring[2] = row_at(roll_.sz + k);
    spring[3] = row_at(roll_.friction + k);
    transpose(moment), transpose(spring);
  }

  // Pair by pair, so that no sum depends on which pairs are gathered together.
  void scatter(int k, int count) {
    Row force[4] = {row_at(x_ + k), row_at(y_ + k), row_at(z_ + k), row_at(difference_ + k)};
    Row turn[4] = {row_at(wx_ + k), row_at(wy_ + k), row_at(wz_ + k), Row{}};
    Row spring[4] = {row_at(sx_ + k), row_at(sy_ + k), row_at(sz_ + k), row_at(damping_ + k)};
    transpose(force), transpose(turn), transpose(spring);
    Row moment[4]{}, rolling_spring[4]{};
    if constexpr (rolling) take_moments(k, moment, rolling_spring);
    for (int m = 0; m < count; ++m) {
      const NearPair& pair = pair_[k + m];
      std::memcpy(pairs_[pair.pair].spring, &spring[m], sizeof(Row));
      MovingGrain &first = grains_[pair.first], &second = grains_[pair.second];
      const Row half = last_everywhere(force[m]), f = force[m] * Row{1.0, 1.0, 1.0, 0.0};
      first.force += f;
      second.force -= f;
      first.torque += (last_everywhere(first.position) - half) * turn[m];
      second.torque += (last_everywhere(second.position) - half) * turn[m];
      if constexpr (!rolling) continue;
      std::memcpy(rolling_pairs_[pair.pair].spring, &rolling_spring[m], sizeof(Row));
      first.torque += moment[m];
      second.torque -= moment[m];
    }
  }

  struct alignas(64) RollingLanes {
    Lane wx, wy, wz;  // spin of the first against the second; then the moment
    Lane sx, sy, sz;  // spring
    Lane friction, inertia;
  };
  struct Nothing {};

  MovingGrains& grains_;
  std::vector<PairContact>& pairs_;
  std::vector<RollingContact>& rolling_pairs_;
  const MinimumImage image_;
  const MaterialTable& materials_;
  std::span<const std::uint8_t> material_;
  NearPair pair_[capacity];
  alignas(64) Lane x_{}, y_{}, z_{}, difference_{};  // separation, difference of radii; then force, overlap/2
  alignas(64) Lane normal_{}, tangential_{}, friction_{};
  alignas(64) Lane reach_{}, damping_{}, unused_{};
  alignas(64) Lane vx_{}, vy_{}, vz_{};     // velocity of the first centre against the second
  alignas(64) Lane rwx_{}, rwy_{}, rwz_{};  // R1 w1 + R2 w2
  alignas(64) Lane wx_{}, wy_{}, wz_{};     // w1 + w2; then the moment
  alignas(64) Lane sx_{}, sy_{}, sz_{};     // spring
  std::conditional_t<rolling, RollingLanes, Nothing> roll_{};
  const double rolling_damping_ = materials_.rolling_damping();
};

}  // namespace thalweg::dem
