// SIMD kernel of the contacts: gathers pairs into arrays, evaluates the contact law for several in one instruction,
// and scatters the forces in the order of the pairs.
// A pair beyond the range of the law goes along with a force of zero: nearly all touch, and adding zero changes no bit
// (no sum here is ever -0, since it began at +0).
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/laws/contact_law.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/minimum_image.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace thalweg::dem {

inline Double4 broadcast_last(const Double4& r) { return Double4{r[3], r[3], r[3], r[3]}; }

inline Double4 double4_at(const double* values) {
  Double4 row;
  std::memcpy(&row, values, sizeof(Double4));
  return row;
}

// The entries of two rows, counted from 0 to 7, that `entry` names.
template <int... entry>
Double4 shuffled(const Double4& first, const Double4& second) {
#if defined(__clang__) || __GNUC__ >= 12
  return __builtin_shufflevector(first, second, entry...);
#else
  using Entries = std::int64_t __attribute__((vector_size(32)));
  return __builtin_shuffle(first, second, Entries{entry...});
#endif
}

// Transposes four rows into four columns, and back.
inline void transpose(Double4 (&r)[4]) {
  const Double4 a = shuffled<0, 4, 2, 6>(r[0], r[1]), b = shuffled<1, 5, 3, 7>(r[0], r[1]);
  const Double4 c = shuffled<0, 4, 2, 6>(r[2], r[3]), d = shuffled<1, 5, 3, 7>(r[2], r[3]);
  r[0] = shuffled<0, 1, 4, 5>(a, c);
  r[1] = shuffled<0, 1, 4, 5>(b, d);
  r[2] = shuffled<2, 3, 6, 7>(a, c);
  r[3] = shuffled<2, 3, 6, 7>(b, d);
}

template <IsContactLaw ContactLaw>
class ContactKernel {
public:
  static constexpr int capacity = 64;
  static constexpr int lanes = 8;  // whole vectors: the last one is filled up with copies of the first pair

  // rows: ContactRows::width_of<ContactLaw> doubles of every pair; material: of every slot.
  ContactKernel(const ContactLaw& law, PackedGrainState& grains, double* rows, const PeriodicBox& box,
                const MaterialTable& materials, std::span<const std::uint8_t> material)
      : law_(law), grains_(grains), rows_(rows), image_(box), materials_(materials), material_(material) {
    // One material's numbers are the same in all lanes, so they are put there once.
    if (materials.count() > 1) return;
    const std::vector<double>& only = materials.pair(0, 0).coefficients;
    for (std::size_t n = 0; n < coefficients; ++n) std::fill_n(coefficient_[n], capacity, only[n]);
  }

  // near: at most `capacity` pairs. Prefetches grains and rows of as many of `behind`, pairs that come later.
  void evaluate(std::span<const NearPair> near, std::span<const NearPair> behind) {
    const int count = static_cast<int>(near.size()), rounded = (count + lanes - 1) / lanes * lanes;
    std::copy(near.begin(), near.end(), pair_);
    std::fill(pair_ + count, pair_ + rounded, near[0]);
    for (int k = 0; k < rounded; k += 4) {
      for (std::size_t n = k; n < std::min<std::size_t>(k + 4, behind.size()); ++n) prefetch(behind[n]);
      gather(k);
    }
    if (materials_.count() > 1) gather_coefficients(rounded);
    evaluate_lanes(rounded);
    for (int k = 0; k < count; k += 4) scatter(k, std::min(4, count - k));
  }

private:
  using Lane = double[capacity];
  using Coefficients = typename ContactLaw::Coefficients;
  using Constants = typename ContactLaw::Constants;
  using History = typename ContactLaw::History;
  static constexpr std::size_t coefficients = doubles_in<Coefficients>, history = std::tuple_size_v<History>;
  static constexpr std::size_t width = ContactRows::width_of<ContactLaw>;

  double* row(const NearPair& pair) const { return rows_ + pair.pair * width; }

  static void store(const Double4 (&r)[4], int k, Lane& x, Lane& y, Lane& z, Lane& last) {
    std::memcpy(x + k, &r[0], sizeof(Double4));
    std::memcpy(y + k, &r[1], sizeof(Double4));
    std::memcpy(z + k, &r[2], sizeof(Double4));
    std::memcpy(last + k, &r[3], sizeof(Double4));
  }

  // Values of lane k of consecutive lanes, as a struct of doubles.
  template <typename Doubles, std::size_t... n>
  static Doubles taken(const Lane* from, int k, std::index_sequence<n...>) {
    return Doubles{from[n][k]...};
  }
  template <typename Doubles>
  static Doubles taken(const Lane* from, int k) {
    return taken<Doubles>(from, k, std::make_index_sequence<doubles_in<Doubles>>());
  }

  // Force-inlined: compilers may drop calls to a function that only prefetches, because it has no visible effect.
  [[gnu::always_inline]] void prefetch(const NearPair& next) const {
    const char* values = reinterpret_cast<const char*>(row(next));
    for (std::size_t line = 0; line < width * sizeof(double); line += 64) __builtin_prefetch(values + line, 1);
    for (const std::uint32_t slot : {next.first, next.second}) {
      const char* grain = reinterpret_cast<const char*>(&grains_[slot]);
      for (std::size_t line = 0; line < sizeof(PackedGrain); line += 64) __builtin_prefetch(grain + line, 1);
    }
  }

  void gather(int k) {
    Double4 separation[4], v[4], rw[4], w[4], values[width / 4][4];
    for (int m = 0; m < 4; ++m) {
      const PackedGrain &first = grains_[pair_[k + m].first], &second = grains_[pair_[k + m].second];
      separation[m] = image_(first.position - second.position);
      v[m] = first.velocity - second.velocity;
      rw[m] = broadcast_last(first.position) * first.spin + broadcast_last(second.position) * second.spin;
      w[m] = first.spin + second.spin;
      for (std::size_t n = 0; n < width / 4; ++n) values[n][m] = double4_at(row(pair_[k + m]) + 4 * n);
      reach_[k + m] = first.position[3] + second.position[3];
    }
    transpose(separation), transpose(v), transpose(rw), transpose(w);
    store(separation, k, x_, y_, z_, difference_);
    store(v, k, vx_, vy_, vz_, unused_);
    store(rw, k, rwx_, rwy_, rwz_, unused_);
    store(w, k, wx_, wy_, wz_, unused_);
    for (std::size_t n = 0; n < width / 4; ++n) {
      transpose(values[n]);
      store(values[n], k, value_[4 * n], value_[4 * n + 1], value_[4 * n + 2], value_[4 * n + 3]);
    }
    if constexpr (ContactLaw::rolls) gather_spins(k);
  }

  void gather_spins(int k) {
    Double4 spin[4];
    for (int m = 0; m < 4; ++m) spin[m] = grains_[pair_[k + m].first].spin - grains_[pair_[k + m].second].spin;
    transpose(spin);
    store(spin, k, roll_.x, roll_.y, roll_.z, unused_);
  }

  void gather_coefficients(int rounded) {
    for (int k = 0; k < rounded; ++k) {
      const double* pair = materials_.pair(material_[pair_[k].first], material_[pair_[k].second]).coefficients.data();
      for (std::size_t n = 0; n < coefficients; ++n) coefficient_[n][k] = pair[n];
    }
  }

  // Force on the first body, and torque per unit of lever arm on both: F_t x n. Flattened: with
  // the law inlined, however many others it is made of, the loop is vectorised.
  [[gnu::flatten]] void evaluate_lanes(int rounded) {
    const ContactLaw law = law_;
    const double range = law.range();
    for (int k = 0; k < rounded; ++k) {
      const double squared = x_[k] * x_[k] + y_[k] * y_[k] + z_[k] * z_[k];
      const double limit = range > 0.0 ? reach_[k] + range : reach_[k];
      const bool acts = squared < limit * limit;
      const double distance = std::sqrt(squared);
      const double inverse = 1.0 / distance, nx = inverse * x_[k], ny = inverse * y_[k], nz = inverse * z_[k];
      const double overlap = reach_[k] - distance, half = 0.5 * overlap;
      // Surface velocity by rotation: -(l1 w1 + l2 w2) x n with the lever arms l = R - overlap/2.
      const double ax = rwx_[k] - half * wx_[k], ay = rwy_[k] - half * wy_[k], az = rwz_[k] - half * wz_[k];
      ContactMotion motion{overlap, nx, ny, nz, vx_[k] - (ay * nz - az * ny), vy_[k] - (az * nx - ax * nz),
                           vz_[k] - (ax * ny - ay * nx),
                           // R1 R2/(R1 + R2) of the sum and the difference of the radii
                           0.25 * (reach_[k] - difference_[k] * difference_[k] / reach_[k])};
      if constexpr (ContactLaw::rolls) motion.wx = roll_.x[k], motion.wy = roll_.y[k], motion.wz = roll_.z[k];
      History kept = taken<History>(value_, k);
      const ContactLoad f =
          law(motion, taken<Coefficients>(coefficient_, k), taken<Constants>(value_ + history, k), kept);
      const auto if_acting = [acts](double value) { return acts ? value : 0.0; };
      [&]<std::size_t... n>(std::index_sequence<n...>) { ((value_[n][k] = if_acting(kept[n])), ...); }
      (std::make_index_sequence<history>());
      if constexpr (ContactLaw::rolls)
        roll_.x[k] = if_acting(f.mx), roll_.y[k] = if_acting(f.my), roll_.z[k] = if_acting(f.mz);
      x_[k] = if_acting(f.normal * nx + f.tx);
      y_[k] = if_acting(f.normal * ny + f.ty);
      z_[k] = if_acting(f.normal * nz + f.tz);
      wx_[k] = if_acting(f.ty * nz - f.tz * ny);
      wy_[k] = if_acting(f.tz * nx - f.tx * nz);
      wz_[k] = if_acting(f.tx * ny - f.ty * nx);
      difference_[k] = half;
    }
  }

  // Pair by pair, so that no sum depends on which pairs are gathered together.
  void scatter(int k, int count) {
    Double4 force[4] = {double4_at(x_ + k), double4_at(y_ + k), double4_at(z_ + k), double4_at(difference_ + k)};
    Double4 turn[4] = {double4_at(wx_ + k), double4_at(wy_ + k), double4_at(wz_ + k), Double4{}};
    transpose(force), transpose(turn);
    Double4 moment[4]{};
    if constexpr (ContactLaw::rolls) {
      moment[0] = double4_at(roll_.x + k), moment[1] = double4_at(roll_.y + k), moment[2] = double4_at(roll_.z + k);
      transpose(moment);
    }
    constexpr std::size_t vectors = (history + 3) / 4;  // of a row that change
    Double4 values[vectors][4];
    for (std::size_t n = 0; n < vectors; ++n) {
      for (std::size_t i = 0; i < 4; ++i) values[n][i] = double4_at(value_[4 * n + i] + k);
      transpose(values[n]);
    }
    for (int m = 0; m < count; ++m) {
      const NearPair& pair = pair_[k + m];
      for (std::size_t n = 0; n < vectors; ++n) std::memcpy(row(pair) + 4 * n, &values[n][m], sizeof(Double4));
      PackedGrain &first = grains_[pair.first], &second = grains_[pair.second];
      const Double4 half = broadcast_last(force[m]), f = force[m] * Double4{1.0, 1.0, 1.0, 0.0};
      first.force += f;
      second.force -= f;
      first.torque += (broadcast_last(first.position) - half) * turn[m];
      second.torque += (broadcast_last(second.position) - half) * turn[m];
      if constexpr (!ContactLaw::rolls) continue;
      first.torque += moment[m];
      second.torque -= moment[m];
    }
  }

  struct alignas(64) RollingLanes {
    Lane x, y, z;  // spin of the first against the second; then the moment
  };
  struct Nothing {};

  const ContactLaw law_;
  PackedGrainState& grains_;
  double* const rows_;
  const MinimumImage image_;
  const MaterialTable& materials_;
  std::span<const std::uint8_t> material_;
  NearPair pair_[capacity];
  alignas(64) Lane x_{}, y_{}, z_{}, difference_{};  // separation, difference of radii; then force, overlap/2
  alignas(64) Lane coefficient_[coefficients]{};
  alignas(64) Lane reach_{}, unused_{};
  alignas(64) Lane vx_{}, vy_{}, vz_{};     // velocity of the first centre against the second
  alignas(64) Lane rwx_{}, rwy_{}, rwz_{};  // R1 w1 + R2 w2
  alignas(64) Lane wx_{}, wy_{}, wz_{};     // w1 + w2; then the moment
  alignas(64) Lane value_[width]{};         // rows of the pairs
  std::conditional_t<ContactLaw::rolls, RollingLanes, Nothing> roll_{};
};

}  // namespace thalweg::dem
