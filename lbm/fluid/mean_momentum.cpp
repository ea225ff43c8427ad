#include "lbm/fluid/mean_momentum.hpp"

#include "core/base/check.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"
#include "lbm/fluid/fluid_packs.hpp"
#include "lbm/fluid/fluid_survey.hpp"

#include <limits>

namespace thalweg::lbm {

namespace {

template <typename Real>
class AxisMomentum {
public:
  using Packs = FluidPacks<Real>;
  using Pack = typename Packs::Pack;
  using Mask = typename Packs::Mask;

  AxisMomentum(const Fluid<Real>& fluid, int axis) : fluid_(fluid), packs_(fluid) {
    const auto sent = fluid.populations().sent();
    std::size_t slot = 0;
    for (int i = 1; i < D3Q19::directions; i += 2) {  // a direction and its opposite
      const int along = D3Q19::c[i][axis];
      if (along == 0) continue;
      slots_[slot++] = sent[along > 0 ? i : i + 1];
      slots_[slot++] = sent[along > 0 ? i + 1 : i];
    }
  }

  double mean() {
    const Index3& n = fluid_.indexing().size();
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) add_row(y, z);
    sum_over_ranks(fluid_.communicator(), std::span<WideSum>(&sum_, 1));
    std::int64_t counts[] = {cells_, broken_};
    MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_INT64_T, MPI_SUM, fluid_.communicator());
    if (counts[1] > 0) return std::numeric_limits<double>::quiet_NaN();
    return sum_.to_double(Packs::fraction_bits) / static_cast<double>(counts[0]);
  }

private:
  struct Lanes {
    Pack momentum = 0.0, fluid = 0.0, broken = 0.0;
  };

  void add_row(int y, int z) {
    Lanes lanes;
    int count = 0;
    packs_.for_each(
        y, z, slots_, [&](int, std::ptrdiff_t cell, const Mask& fluid) __attribute__((always_inline)) {
          if (count++ == Packs::most_packs) {
            take(lanes);
            lanes = {};
            count = 1;
          }
          add(lanes, cell, fluid);
        });
    take(lanes);
  }

  [[gnu::always_inline]] void add(Lanes& lanes, std::ptrdiff_t cell, const Mask& fluid) const {
    Pack momentum = 0.0;
#pragma GCC unroll 5
    for (std::size_t slot = 0; slot < slots_.size(); slot += 2)
      momentum += Pack(slots_[slot] + cell, std::experimental::element_aligned) -
                  Pack(slots_[slot + 1] + cell, std::experimental::element_aligned);
    constexpr double most = FluidSurvey::broken_value;
    const Mask good = fluid && momentum < most && momentum > -most;  // false of what is not a number
    lanes.momentum += Packs::where_else(good, Packs::rounded(momentum), 0.0);
    lanes.fluid += Packs::where_else(fluid, Pack(1.0), 0.0);
    lanes.broken += Packs::where_else(fluid && !good, Pack(1.0), 0.0);
  }

  void take(const Lanes& lanes) {
    sum_.add(Packs::total(lanes.momentum));
    cells_ += Packs::total(lanes.fluid);
    broken_ += Packs::total(lanes.broken);
  }

  const Fluid<Real>& fluid_;
  Packs packs_;
  std::array<const Real*, 10> slots_;  // what cells sent along the axis, each followed by its opposite
  WideSum sum_;
  std::int64_t cells_ = 0, broken_ = 0;
};

}  // namespace

template <typename Real>
double mean_momentum(const Fluid<Real>& fluid, int axis) {
  CHECK(axis >= 0 && axis < 3);
  return AxisMomentum<Real>(fluid, axis).mean();
}

template double mean_momentum(const Fluid<float>&, int);
template double mean_momentum(const Fluid<double>&, int);

}  // namespace thalweg::lbm
