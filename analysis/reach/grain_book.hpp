// The book of the grains of a reach: what each has done since the look before.
//
// A grain crosses the sections between the places of its centre at two looks (way_between.hpp). A grain that is seen
// for the first time, or again, has arrived; one that is no longer seen has left, where it was seen last. Where grains
// recirculate, one that is farther away than farthest_away() from where its velocities would have
// taken it has left and arrived anew. What a grain does between its last look and a sink, or its entrance and the first
// look at it, is not seen; the balance of each bin closes all the same.
//
// A clump is one grain. The memory of a grain is at the home of its id (distribution_by_id.hpp).
#pragma once

#include "analysis/reach/sections.hpp"
#include "analysis/tools/distribution_by_id.hpp"
#include "analysis/tools/hops.hpp"
#include "analysis/tools/way_between.hpp"
#include "core/geometry/periodic_box.hpp"

#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace thalweg::analysis {

// What a grain can do from one look to the next: the first two at a section, the others in a bin. A grain is entrained
// in the bin where it was last at rest, and deposited in that where it is found at rest.
enum class Passage { downstream, upstream, arrived, left, entrained, deposited };
inline constexpr std::size_t passage_kinds = 6;

class GrainBook {
public:
  // diameter: m, the reference one. moving_speed: m/s, above which a grain moves. recirculation: grains may be taken
  // out of the box and put in elsewhere from one look to the next.
  GrainBook(MPI_Comm communicator, const Sections& sections, double diameter, double moving_speed, bool recirculation)
      : communicator_(communicator),
        sections_(sections),
        diameter_(diameter),
        moving_speed_(moving_speed),
        recirculation_(recirculation) {}

  static constexpr double bytes_per_id() { return sizeof(Memory); }  // of what it keeps

  struct Entry {
    Passage passage;
    std::int64_t place;  // number of the section or the bin
    double volume;       // m^3, of the grain
  };
  struct Page {
    std::vector<Entry> entries;
    std::vector<double> stays;  // s: how long those that have left had been here, if they came in after the first look
  };
  // Takes a look at all bodies, and returns what those have done whose home is here. The first look finds them as they
  // are. end_of_ids: as GrainView has it. Collective.
  Page look(double time, const PeriodicBox& box, GlobalId end_of_ids, const std::vector<Body>& bodies);

  void save(ArchiveWriter& archive, const std::string& group) const;  // collective
  // Where there was no look yet, it begins here. bodies: in the box at the latest look. Throws DamagedFile if fewer are
  // remembered, or values that no grain has. Collective.
  void load(ArchiveReader& archive, const std::string& group, std::int64_t bodies);

private:
  enum State { absent = 0, at_rest = 1, moving = 2 };
  // Memory of a body, at its home.
  struct Memory {
    State state = absent;
    Look latest = {};
    double volume = 0.0;  // m^3
    double since = 0.0;   // s, of its arrival; negative: it was there at first
  };
  static constexpr std::size_t columns = 9;

  struct Sighting {
    GlobalId id;
    double x, y, z, v_x, v_y, v_z, volume;
  };
  // What to compare the places of two looks by.
  struct Interval {
    double time, duration;  // s
    double farthest;        // m, that a grain can be away from where its velocities would have taken it
    bool first;
    const PeriodicBox& box;
  };
  void follow(Memory& memory, const Sighting& seen, const Interval& interval, Page& page) const;
  // Number of boxes along x that lie between the place where a grain has come to and its image in the box; none: it has
  // left between the looks.
  std::optional<std::int64_t> boxes_gone(const Memory& before, const Memory& now, const Interval& interval) const;
  void cross(std::int64_t from, std::int64_t to, double volume, Page& page) const;
  void leave(const Memory& memory, double time, Page& page) const;

  MPI_Comm communicator_;
  Sections sections_;
  double diameter_, moving_speed_;
  bool recirculation_;
  std::optional<DistributionById> homes_;  // from the first look on
  std::vector<Memory> memory_;             // of the ids whose home is here
  double last_time_ = 0.0;                 // s, of the latest look
  double last_speed_ = 0.0;                // m/s, the largest then
};

}  // namespace thalweg::analysis
