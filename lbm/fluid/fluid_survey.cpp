#include "lbm/fluid/fluid_survey.hpp"

#include "core/sums/wide_sums_over_ranks.hpp"
#include "lbm/fluid/fluid_packs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace thalweg::lbm {

namespace {

namespace stdx = std::experimental;

using Pack = FluidPacks<float>::Pack;
using Mask = FluidPacks<float>::Mask;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t nowhere = std::numeric_limits<std::int64_t>::max();

struct CellPack {
  Pack deviation, momentum[3], speed_squared;
  Mask fluid, broken;
};

// Sums over a stretch of a row, lane by lane.
struct Lanes {
  Pack mass = 0.0, momentum[3] = {0.0, 0.0, 0.0};  // multiples of 2^-36
  Pack x_sum = 0.0, fluid = 0.0, fast = 0.0, broken = 0.0;
  Pack lowest = infinity, highest = -infinity, fastest = -infinity;  // the last one squared
};

// An extreme value of this rank (smaller is more extreme) and the row it was first found in.
struct RowExtreme {
  double value = infinity;
  int y = -1, z = -1;

  void consider(double candidate, int row_y, int row_z) {
    if (candidate < value) *this = {candidate, row_y, row_z};
  }
};

template <typename Real>
class Survey {
public:
  explicit Survey(const Fluid<Real>& fluid) : fluid_(fluid), packs_(fluid), slots_(fluid.populations().sent()) {
    for (int a = 0; a < 3; ++a) half_force_[a] = 0.5 * fluid.carried_force()[a];
  }

  FluidSurvey run() {
    const Index3& n = fluid_.indexing().size();
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) {
        Lanes lanes;
        int packs = 0;
        for_each_pack(
            y, z, [&](int x, const CellPack& cells) __attribute__((always_inline)) {
              if (packs++ == Packs::most_packs) {
                add_row(lanes, y, z);
                lanes = {};
                packs = 1;
              }
              add(lanes, cells, x);
            });
        add_row(lanes, y, z);
      }
    return combined();
  }

private:
  using Packs = FluidPacks<Real>;

  // Calls visit(x of the first cell, cells) for every pack of doubles of a row that may hold fluid.
  template <typename Visit>
  [[gnu::always_inline]] void for_each_pack(int y, int z, Visit visit) const {
    packs_.for_each(
        y, z, slots_, [&](int x, std::ptrdiff_t cell, const Mask& fluid) __attribute__((always_inline)) {
          visit(x, look(cell, fluid));
        });
  }

  [[gnu::always_inline]] CellPack look(std::ptrdiff_t cell, const Mask& fluid) const {
    CellPack c;
    c.fluid = fluid;
    c.deviation = Pack(slots_[0] + cell, stdx::element_aligned);
    c.momentum[0] = c.momentum[1] = c.momentum[2] = 0.0;
#pragma GCC unroll 9
    for (int i = 1; i < D3Q19::directions; i += 2) {  // a direction and its opposite
      const Pack there(slots_[i] + cell, stdx::element_aligned), back(slots_[i + 1] + cell, stdx::element_aligned);
      const Pack flux = there - back;
      c.deviation += there + back;
      for (int a = 0; a < 3; ++a) {
        if (D3Q19::c[i][a] > 0) c.momentum[a] += flux;
        if (D3Q19::c[i][a] < 0) c.momentum[a] -= flux;
      }
    }
    const Pack x = c.momentum[0] - half_force_[0], y = c.momentum[1] - half_force_[1],
               z = c.momentum[2] - half_force_[2], rho = 1.0 + c.deviation;
    const Pack squared = x * x + y * y + z * z;
    c.speed_squared = squared / (rho * rho);
    constexpr double most = FluidSurvey::broken_value;
    // Comparisons with what is not a number are false.
    c.broken =
        c.fluid && !(c.deviation < most && c.deviation > -most && squared < most * most && c.speed_squared < infinity);
    return c;
  }

  [[gnu::always_inline]] void add(Lanes& lanes, const CellPack& c, int x) const {
    const Mask good = c.fluid && !c.broken;
    lanes.mass += Packs::where_else(good, Packs::rounded(c.deviation), 0.0);
    for (int a = 0; a < 3; ++a) lanes.momentum[a] += Packs::where_else(good, Packs::rounded(c.momentum[a]), 0.0);
    lanes.x_sum += Packs::where_else(c.fluid, packs_.lane() + static_cast<double>(x), 0.0);
    lanes.fluid += Packs::where_else(c.fluid, Pack(1.0), 0.0);
    lanes.fast += Packs::where_else(good && c.speed_squared > FluidSurvey::fast * FluidSurvey::fast, Pack(1.0), 0.0);
    lanes.broken += Packs::where_else(c.broken, Pack(1.0), 0.0);
    lanes.lowest = stdx::min(lanes.lowest, Packs::where_else(good, c.deviation, infinity));
    lanes.highest = stdx::max(lanes.highest, Packs::where_else(good, c.deviation, -infinity));
    lanes.fastest = stdx::max(lanes.fastest, Packs::where_else(good, c.speed_squared, -infinity));
  }

  void add_row(const Lanes& lanes, int y, int z) {
    const Index3 &lower = fluid_.block().lower, &cells = fluid_.decomposition().cells();
    sums_[0].add(Packs::total(lanes.mass));
    for (int a = 0; a < 3; ++a) sums_[1 + a].add(Packs::total(lanes.momentum[a]));
    const std::int64_t count = Packs::total(lanes.fluid), broken = Packs::total(lanes.broken);
    const std::int64_t twice_x = 2 * Packs::total(lanes.x_sum) + count * (2 * lower[0] + 1 - cells[0]);
    counts_[fluid_cells] += count;
    counts_[fast_cells] += Packs::total(lanes.fast);
    counts_[broken_cells] += broken;
    counts_[lever_x] += twice_x;
    counts_[lever_y] += count * (2 * (lower[1] + y) + 1 - cells[1]);
    counts_[lever_z] += count * (2 * (lower[2] + z) + 1 - cells[2]);
    extremes_[lowest].consider(stdx::hmin(lanes.lowest), y, z);
    extremes_[highest].consider(-stdx::hmax(lanes.highest), y, z);
    extremes_[fastest].consider(-stdx::hmax(lanes.fastest), y, z);
    if (broken > 0) extremes_[first_broken].consider(0.0, y, z);
  }

  // The place of an extreme in the order of cells along x, then y, then z of the whole domain; `nowhere` if this rank
  // does not have it.
  std::int64_t location_of(int extreme, double value) const {
    const RowExtreme& e = extremes_[extreme];
    if (e.y < 0 || e.value != value) return nowhere;
    const Index3 &lower = fluid_.block().lower, &cells = fluid_.decomposition().cells();
    int first = std::numeric_limits<int>::max();
    for_each_pack(e.y, e.z, [&](int x, const CellPack& c) {
      const Mask good = c.fluid && !c.broken;
      const Mask found = extreme == lowest    ? good && c.deviation == value
                         : extreme == highest ? good && -c.deviation == value
                         : extreme == fastest ? good && -c.speed_squared == value
                                              : c.broken;
      if (stdx::any_of(found)) first = std::min(first, x + stdx::find_first_set(found));
    });
    return (std::int64_t{lower[2] + e.z} * cells[1] + lower[1] + e.y) * cells[0] + lower[0] + first;
  }

  Index3 cell_at(std::int64_t place) const {
    if (place == nowhere) return {-1, -1, -1};
    const Index3& n = fluid_.decomposition().cells();
    return {static_cast<int>(place % n[0]), static_cast<int>(place / n[0] % n[1]),
            static_cast<int>(place / n[0] / n[1])};
  }

  // Over all ranks.
  FluidSurvey combined() {
    const MPI_Comm communicator = fluid_.communicator();
    sum_over_ranks(communicator, sums_);
    MPI_Allreduce(MPI_IN_PLACE, counts_.data(), counts, MPI_INT64_T, MPI_SUM, communicator);
    std::array<double, extremes> values;
    for (int e = 0; e < extremes; ++e) values[e] = extremes_[e].value;
    MPI_Allreduce(MPI_IN_PLACE, values.data(), extremes, MPI_DOUBLE, MPI_MIN, communicator);
    std::array<std::int64_t, extremes> places;
    for (int e = 0; e < extremes; ++e) places[e] = location_of(e, values[e]);
    MPI_Allreduce(MPI_IN_PLACE, places.data(), extremes, MPI_INT64_T, MPI_MIN, communicator);

    FluidSurvey s;
    s.totals = {sum(0), Vec3(sum(1), sum(2), sum(3)), counts_[fluid_cells]};
    s.lever = 0.5 * Vec3(double(counts_[lever_x]), double(counts_[lever_y]), double(counts_[lever_z]));
    s.fast_cells = counts_[fast_cells];
    s.broken_cells = counts_[broken_cells];
    if (s.broken_cells > 0) {
      const Index3 cell = cell_at(places[first_broken]);
      constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
      s.totals.mass_deviation = no_number;
      s.totals.momentum.setConstant(no_number);
      s.lowest = {-infinity, cell};
      s.highest = s.fastest = {infinity, cell};
    } else if (s.totals.cells > 0) {
      s.lowest = {values[lowest], cell_at(places[lowest])};
      s.highest = {-values[highest], cell_at(places[highest])};
      s.fastest = {std::sqrt(-values[fastest]), cell_at(places[fastest])};
    }
    return s;
  }

  double sum(int s) const { return sums_[s].to_double(Packs::fraction_bits); }

  enum Count { fluid_cells, fast_cells, broken_cells, lever_x, lever_y, lever_z, counts };  // levers: half cells
  enum Extreme { lowest, highest, fastest, first_broken, extremes };  // negative where the largest is meant

  const Fluid<Real>& fluid_;
  FluidPacks<Real> packs_;
  std::array<const Real*, D3Q19::directions> slots_;  // Populations::sent()
  double half_force_[3];
  std::array<WideSum, 4> sums_{};  // mass, momentum
  std::array<std::int64_t, counts> counts_{};
  std::array<RowExtreme, extremes> extremes_{};
};

}  // namespace

template <typename Real>
FluidSurvey survey_of(const Fluid<Real>& fluid) {
  return Survey<Real>(fluid).run();
}

template FluidSurvey survey_of(const Fluid<float>&);
template FluidSurvey survey_of(const Fluid<double>&);

}  // namespace thalweg::lbm
