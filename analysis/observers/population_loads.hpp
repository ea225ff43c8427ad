// Force and torque on the grains of a population together: what a bumpy wall, a plate, a drum or a bed carries.
//
//   F = sum of F_i,   T = sum of (x_i - x_p) x F_i + T_i,   of contacts and of the fluid apart
//
// over its grains i, x_p the pivot; x_i - x_p is the shortest way in a periodic box. Contact forces are those at the
// end of the step, fluid forces those applied during it. Forces between grains of the population cancel. Summed with
// the same bits on any number of ranks.
#pragma once

#include "analysis/observer/latest_values.hpp"
#include "analysis/observer/observer_keys.hpp"
#include "core/geometry/periodic_box.hpp"

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg::analysis {

struct PopulationLoadsKeys {
  static constexpr const char* section = "population_loads";
  static constexpr const char* meaning = "force and torque on each population of grains, in series.csv; no keys: {}";
  static constexpr Needs needs = Needs::grains;
  bool operator==(const PopulationLoadsKeys&) const = default;
};
void describe(SectionVisitor& visit, PopulationLoadsKeys& keys);
std::unique_ptr<Observer> make_observer(const PopulationLoadsKeys& keys, const RunContext& run,
                                        const RunningSystem& system);
// It keeps sums by population, nothing of a grain.
inline ObserverMemory memory_of(const PopulationLoadsKeys&, const RunContext&, const RunSize&) { return {}; }

class PopulationLoads : public Observer {
public:
  // with_fluid: fluid forces, too. supplied: as PopulationIds has it.
  PopulationLoads(MPI_Comm communicator, const PeriodicBox& box, std::vector<PopulationContext> populations,
                  bool with_fluid, std::vector<std::int64_t> supplied = {});

  std::string name() const override { return "population_loads"; }
  void observe(const Snapshot& snapshot) override;

  // Columns of each population: NAME_contact_force_x, _y, _z (N), NAME_contact_torque_x, ... (N m), and
  // NAME_fluid_force_x, NAME_fluid_torque_x, ...
  std::vector<Diagnostic> diagnostics() const override { return diagnostics_; }

  void save(ArchiveWriter& archive) const override { save_latest(archive, name(), diagnostics_); }
  bool load(ArchiveReader& archive) override {
    load_latest(archive, name(), diagnostics_);
    return true;
  }

private:
  MPI_Comm communicator_;
  PeriodicBox box_;
  std::vector<PopulationContext> populations_;
  PopulationIds ids_;
  bool with_fluid_;
  std::vector<Diagnostic> diagnostics_;
};

}  // namespace thalweg::analysis
