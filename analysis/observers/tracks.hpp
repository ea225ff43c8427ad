// The tracks of chosen grains: where they are, how they move and turn, and what acts on them, at short intervals.
//
// Positions continue across the faces of a periodic box (way_between.hpp). A grain that has left by a sink has no
// numbers, and begins anew inside the box where it comes in again. A member of a clump is recorded as the sphere it is,
// with the orientation of the clump.
#pragma once

#include "analysis/observer/observer_keys.hpp"
#include "analysis/tools/grain_record.hpp"
#include "analysis/tools/way_between.hpp"
#include "core/geometry/periodic_box.hpp"

#include <mpi.h>

#include <optional>
#include <vector>

namespace thalweg::analysis {

struct TracksKeys {
  static constexpr const char* section = "tracks";
  static constexpr const char* meaning = "positions, motion and forces of chosen grains at short intervals, in tracks/";
  static constexpr Needs needs = Needs::grains;
  // All that is recorded passes through rank 0, which holds up to 100 measurements: 14.4 kB a grain, 17.6 with clumps.
  static constexpr std::int64_t most_grains = 20'000;
  std::vector<GlobalId> grains;  // ids; empty: every one_in-th grain
  std::int64_t one_in = 1;
  double every = 1e-3;  // s
  bool operator==(const TracksKeys&) const = default;
};
void describe(SectionVisitor& visit, TracksKeys& keys);
void check(const TracksKeys& keys, const RunContext& run);
std::unique_ptr<Observer> make_observer(const TracksKeys& keys, const RunContext& run, const RunningSystem& system);
ObserverMemory memory_of(const TracksKeys& keys, const RunContext& run, const RunSize& size);

class Tracks : public Observer {
public:
  // grains: ids, ascending, each once. every: s, between measurements. clumps: orientations are recorded. diameter: m,
  // the reference one, where grains may be taken out of the box and put in elsewhere from one measurement to the next.
  Tracks(MPI_Comm communicator, std::vector<GlobalId> grains, double every, bool clumps = false,
         std::optional<double> diameter = {});

  std::string name() const override { return "tracks"; }
  double every() const override { return every_; }
  bool is_lightweight() const override { return true; }
  void observe(const Snapshot& snapshot) override;  // a step seen before does not count again

  std::vector<Diagnostic> diagnostics() const override { return {}; }
  // tracked_grains, track_measurements (1).
  std::vector<Diagnostic> results() const override;

  // Fixed: id. Rows: time (s), [time] and of each grain in the order of ids, [time, grain, axis]: those of GrainRecord;
  // with clumps orientation, [time, grain, component], the unit quaternion w, x, y, z that turns vectors from the frame
  // of the principal axes into space, 1, 0, 0, 0 of spheres. Not a number of a grain that is not there.
  bool has_records() const override { return true; }
  Records take_records() override;

  void save(ArchiveWriter& archive) const override;
  bool load(ArchiveReader& archive) override;  // begins anew where the archive has other grains

private:
  void record_orientations(const Snapshot& snapshot);
  // Rows of grains in the order of grains_, with numbers of those that are there. On rank 0.
  std::vector<GrainRecord> in_order(const std::vector<GrainRecord>& records) const;
  void go_on(std::vector<GrainRecord>& records, double duration, const PeriodicBox& box) const;
  std::size_t index_of(GlobalId id) const;

  MPI_Comm communicator_;
  std::vector<GlobalId> grains_;
  double every_;
  bool clumps_;
  std::optional<double> diameter_;
  std::int64_t seen_step_ = -1, measurements_ = 0;
  double last_time_ = 0.0;                  // s
  std::vector<GrainRecord> last_;           // on rank 0, at the latest measurement
  std::vector<double> times_;               // s, since take_records(); on rank 0
  std::vector<std::vector<double>> since_;  // the same of each quantity
  std::vector<double> orientations_;        // the same; empty without clumps
};

}  // namespace thalweg::analysis
