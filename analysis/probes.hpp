// Velocity and pressure of the fluid in chosen cells, at short intervals.
#pragma once

#include "analysis/observer.hpp"
#include "core/decomposition.hpp"

#include <mpi.h>

#include <vector>

namespace thalweg::analysis {

class Probes : public Observer {
public:
  // points: m, in the box; each stands for the cell that it lies in. every: s, between measurements.
  Probes(MPI_Comm communicator, const Decomposition& decomposition, const std::vector<Vec3>& points, double every);

  std::string name() const override { return "probes"; }
  double every() const override { return every_; }
  bool in_passing() const override { return true; }
  void observe(const Snapshot& snapshot) override;  // a step seen before does not count again

  std::vector<Figure> figures() const override { return {}; }
  // probes, probe_measurements (1).
  std::vector<Figure> results() const override;

  // Fixed: cell_x, cell_y, cell_z of each point, whose centre is half a cell further. Rows: time (s); velocity (m/s)
  // [time, point, axis] and pressure (Pa) [time, point], both NaN while a grain covers the cell's centre.
  bool has_records() const override { return true; }
  Records take_records() override;

  void save(ArchiveWriter& archive) const override;
  void load(ArchiveReader& archive) override;

private:
  MPI_Comm communicator_;
  std::vector<Index3> cells_;
  std::vector<std::size_t> mine_;  // points in this rank's block
  double every_;
  std::int64_t seen_step_ = -1, measurements_ = 0;
  std::vector<double> times_, velocities_, pressures_;  // s, m/s, Pa since take_records(); on rank 0
};

}  // namespace thalweg::analysis
