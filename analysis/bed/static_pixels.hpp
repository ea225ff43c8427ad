// The surface of what stands still, as a camera at the side of a flume sees it (Zhang et al. 2022, section 4.1): the
// view along y is divided into pixels, and a pixel is static if one and the same grain has covered its centre at every
// look for a given time. The surface is the upper edge of the highest static pixel of each column.
//
// The looks of one such time make a picture, then the next picture begins. A grain covers a disk with its whole radius,
// whatever stands in front of it. Pixels that one grain has covered at all looks are kept, with the grain, at the home
// of its id (distribution_by_id.hpp): a highest and a lowest pixel for each column, since what disks have in common has
// no gaps along a column.
#pragma once

#include "analysis/tools/distribution_by_id.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/state/snapshot.hpp"

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::analysis {

class StaticPixels {
public:
  // pixel: side of a pixel, m; along x it is changed so that a whole number of columns fills the box.
  // static_time: s, of a picture.
  StaticPixels(MPI_Comm communicator, const PeriodicBox& box, double pixel, double static_time);

  // Bytes that it keeps of an id, where the largest grain is so wide (m).
  double bytes_per_id(double largest_diameter) const {
    return sizeof(std::int64_t) + static_cast<double>(columns_covered(0.5 * largest_diameter)) * sizeof(Rows);
  }

  // The same of the row that save() writes.
  double saved_bytes_per_id(double largest_diameter) const {
    return static_cast<double>(1 + 2 * columns_covered(0.5 * largest_diameter)) * sizeof(std::int64_t);
  }

  // Takes a look. True if it completes a picture. left_out: of each grain here, whether the view leaves it out; empty:
  // none. Collective.
  bool look(const Snapshot& snapshot, std::span<const char> left_out = {});

  std::int64_t columns() const { return columns_; }
  double column_width() const { return width_; }   // m
  double begun() const { return picture_begun_; }  // s, of the latest picture
  // Surface of the latest picture, m above the floor, one per column; 0 where no pixel is static. Empty before the
  // first picture.
  const std::vector<double>& surface() const { return surface_; }
  static bool is_static(double height) { return height > 0.0; }  // one of surface()

  void save(ArchiveWriter& archive, const std::string& group) const;  // collective
  // False, and nothing done, where there is nothing that fits. Throws DamagedFile. Collective.
  bool load(ArchiveReader& archive, const std::string& group);

private:
  struct Rows {
    std::int32_t lowest = 0, highest = -1;  // empty if lowest > highest
  };
  struct Disk {
    GlobalId id;
    double x, z, radius;
  };
  Rows covered(const Disk& disk, double x, std::int64_t column) const;
  std::int64_t columns_covered(double radius) const;
  std::int64_t first_column(double x, double radius) const;
  double near(double x, std::int64_t column) const;
  void make_room_for(const GrainView& grains);
  void forget_others(const std::vector<Disk>& disks);
  void begin(const Disk& disk);
  void narrow(const Disk& disk);
  void finish();

  MPI_Comm communicator_;
  PeriodicBox box_;
  std::int64_t columns_;
  double width_, height_;                  // m, of a pixel
  double static_time_;                     // s
  std::optional<DistributionById> homes_;  // from the first look on
  std::int64_t columns_a_grain_ = 0;       // columns that the largest grain so far can cover
  std::vector<std::int64_t> first_;        // of each grain whose home is here: its first column, may be outside the box
  std::vector<Rows> rows_;                 // of each such grain and its columns
  double begun_ = 0.0, picture_begun_ = 0.0;  // s: of the looks under way, and of the latest picture
  std::vector<double> surface_;
};

}  // namespace thalweg::analysis
