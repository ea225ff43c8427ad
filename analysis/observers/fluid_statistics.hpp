// Mean flow and Reynolds stresses, gathered while the run goes on.
//
//   U_a = <u_a>,   R_ab = <u_a u_b> - <u_a><u_b>                                        (m/s, m^2/s^2)
//
// < > is the mean over the fluid cells of a layer of cells at one height, and over the measurements: profiles over z.
// Between side walls also over the fluid cells of a line along x: sections over y and z. There the mean flow varies
// along y, and R of a layer contains this variation as well.
//
// Every velocity counts as a multiple of 2^-40 of the lattice velocity unit and sums are integers of 128 bits, so that
// the means have the same bits on any number of ranks and after any restart, however large the layers and however many
// the measurements.
#pragma once

#include "analysis/observer/mean_observer.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "core/sums/wide_sum.hpp"

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace thalweg::analysis {

struct FluidStatisticsKeys {
  static constexpr const char* section = "fluid_statistics";
  static constexpr const char* meaning =
      "mean velocity and Reynolds stresses in profiles.h5: over z, and over y and z between side walls";
  static constexpr Needs needs = Needs::fluid;
  double from = 0.0;    // s: the means begin here
  double every = 0.01;  // s: between measurements
  bool operator==(const FluidStatisticsKeys&) const = default;
};
void describe(SectionVisitor& visit, FluidStatisticsKeys& keys);
std::unique_ptr<Observer> make_observer(const FluidStatisticsKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
// It keeps sums by layer, nothing of a grain.
inline ObserverMemory memory_of(const FluidStatisticsKeys&, const RunContext&, const RunSize&) { return {}; }

class FluidStatistics : public MeanObserver {
public:
  // velocity_unit: m/s of one cell a step. sections: profiles over y and z too.
  FluidStatistics(MPI_Comm communicator, const Decomposition& decomposition, double velocity_unit,
                  const FluidStatisticsKeys& keys, bool sections);

  std::vector<Diagnostic> results() const override;  // mean_velocity_x (m/s), mean_from (s), measurements (1)

  // z (m), velocity (m/s: x, y, z), reynolds_stress (m^2/s^2: xx, yy, zz, xy, xz, yz), fluid_fraction (1), over z; and
  // between side walls y (m), section_velocity, section_reynolds_stress, section_fluid_fraction, over z and y. Zero
  // where there was no fluid.
  std::vector<Profile> profiles() const override;

private:
  enum Quantity { count, velocity = 1, product = 4, quantities = 10 };  // columns of a bin
  struct Means {
    double fluid_fraction = 0.0;
    double velocity[3] = {}, stress[6] = {};
  };

  bool measure(const Snapshot& snapshot, bool counts) override;
  void add(const Snapshot& snapshot) override;
  void save_sums(ArchiveWriter& archive, const std::string& group) const override;
  bool load_sums(ArchiveReader& archive, const std::string& group) override;
  std::vector<std::uint64_t> shape() const { return {static_cast<std::uint64_t>(bins()), quantities, 2}; }
  int bins() const { return sections_ ? cells_[1] * cells_[2] : cells_[2]; }
  std::vector<WideSum> layer(int z) const;
  Means means_of(const WideSum* sums, double cells) const;

  Index3 cells_;
  double spacing_, velocity_unit_;
  bool sections_;
  std::vector<WideSum> sums_;  // quantities of each bin; over all ranks, on every rank
};

}  // namespace thalweg::analysis
