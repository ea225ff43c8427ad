// Velocity and pressure of the fluid in chosen cells, at short intervals.
#pragma once

#include "analysis/observer/observer_keys.hpp"
#include "core/parallel/decomposition.hpp"

#include <mpi.h>

#include <vector>

namespace thalweg::analysis {

// A row of points at equal distances, both ends included.
struct ProbeLine {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  // m
  std::int64_t points = 10;
  bool operator==(const ProbeLine&) const = default;
};

struct ProbesKeys {
  static constexpr const char* section = "probes";
  static constexpr const char* meaning =
      "velocity and pressure of the fluid at points and along lines at short intervals, in probes/";
  static constexpr Needs needs = Needs::fluid;
  std::vector<Vec3> points;  // m
  std::vector<ProbeLine> lines;
  double every = 1e-3;  // s
  bool operator==(const ProbesKeys&) const = default;
};
void describe(SectionVisitor& visit, ProbesKeys& keys);
void check(const ProbesKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const ProbesKeys& keys, const RunContext& run, const RunningSystem& system);
ObserverMemory memory_of(const ProbesKeys& keys, const RunContext& run, const RunSize& size);

class Probes : public Observer {
public:
  // points: m, in the box; each is measured in the cell that contains it. every: s, between measurements.
  Probes(MPI_Comm communicator, const Decomposition& decomposition, const std::vector<Vec3>& points, double every);

  std::string name() const override { return "probes"; }
  double every() const override { return every_; }
  bool is_lightweight() const override { return true; }
  void observe(const Snapshot& snapshot) override;  // a step seen before does not count again

  std::vector<Diagnostic> diagnostics() const override { return {}; }
  // probes, probe_measurements (1).
  std::vector<Diagnostic> results() const override;

  // Fixed: cell_x, cell_y, cell_z of each point, whose centre is half a cell further. Rows: time (s); velocity (m/s)
  // [time, point, axis] and pressure (Pa) [time, point], both NaN while a grain covers the cell's centre.
  bool has_records() const override { return true; }
  Records take_records() override;

  void save(ArchiveWriter& archive) const override;
  bool load(ArchiveReader& archive) override;

private:
  MPI_Comm communicator_;
  std::vector<Index3> cells_;
  std::vector<std::size_t> mine_;  // points in this rank's block
  double every_;
  std::int64_t seen_step_ = -1, measurements_ = 0;
  std::vector<double> times_, velocities_, pressures_;  // s, m/s, Pa since take_records(); on rank 0
};

}  // namespace thalweg::analysis
