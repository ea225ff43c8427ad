// Sums of one step over the links of a grain, on the way from its body to its load. As 64-bit integers, so that dem
// adds the sums of ghosts to those of their owners without knowing what they mean (GrainDynamics::add_ghost_values()).
#pragma once

#include "bodies/map/link_table.hpp"
#include "core/base/check.hpp"
#include "core/sums/fixed_point.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace thalweg::coupling {

// Lattice units; LatticeFixed sums of what LinkBody has.
struct GrainSums {
  FixedVec3 force, torque;
  std::int64_t mass = 0, pressure = 0;
  bodies::LinkSums links;
};

// Sums that only the stress of a grain needs.
struct StressSums {
  FixedTensor moments;                               // F_a x_b
  std::array<std::int64_t, 3> occluded_by_solids{};  // in 36ths (bodies::OccludedPatches::by_solids())
};

// A row of integers for each grain of the store: its GrainSums and, in a step with stress, its StressSums.
class GrainSumRows {
public:
  void begin(std::size_t grains, bool with_stress) {
    width_ = words<GrainSums> + (with_stress ? words<StressSums> : 0);
    values_.resize(grains * static_cast<std::size_t>(width_));
  }
  int width() const { return width_; }  // integers of a grain
  std::vector<std::int64_t>& values() { return values_; }

  void set(std::size_t grain, const GrainSums& sums) { write(grain, 0, sums); }
  void set(std::size_t grain, const StressSums& sums) { write(grain, words<GrainSums>, sums); }
  GrainSums of(std::size_t grain) const { return read<GrainSums>(grain, 0); }
  StressSums stress_of(std::size_t grain) const { return read<StressSums>(grain, words<GrainSums>); }

private:
  template <typename Sums>
  static constexpr int words = static_cast<int>(sizeof(Sums) / sizeof(std::int64_t));
  static_assert(words<GrainSums> == 8 + bodies::LinkSums::size && words<StressSums> == 12, "no padding");

  template <typename Sums>
  std::size_t first_of(std::size_t grain, int word) const {
    static_assert(std::is_trivially_copyable_v<Sums>);
    CHECK(word + words<Sums> <= width_);
    const std::size_t first = grain * static_cast<std::size_t>(width_) + static_cast<std::size_t>(word);
    CHECK(first + words<Sums> <= values_.size());
    return first;
  }
  template <typename Sums>
  void write(std::size_t grain, int word, const Sums& sums) {
    std::memcpy(values_.data() + first_of<Sums>(grain, word), &sums, sizeof(Sums));
  }
  template <typename Sums>
  Sums read(std::size_t grain, int word) const {
    Sums sums;
    std::memcpy(static_cast<void*>(&sums), values_.data() + first_of<Sums>(grain, word), sizeof(Sums));
    return sums;
  }

  int width_ = words<GrainSums>;
  std::vector<std::int64_t> values_;
};

}  // namespace thalweg::coupling
