#include "driver/setup/bed_archive.hpp"

#include "core/parallel/row_range.hpp"
#include "driver/setup/checkpoint_file.hpp"
#include "io/hdf5/bed_file.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace thalweg::driver {

namespace {

std::string group_of(std::size_t population) { return fmt::format("bed_{}", population); }

constexpr std::uint64_t body_columns = 11;  // volume, from_first, moments, orientation

std::vector<double> columns_of(const BedBody& body) {
  std::vector<double> columns{body.volume};
  columns.insert(columns.end(), body.from_first.data(), body.from_first.data() + 3);
  columns.insert(columns.end(), body.moments.data(), body.moments.data() + 3);
  columns.insert(columns.end(), body.orientation.begin(), body.orientation.end());
  return columns;
}

// One row for every clump, where the file had bodies of all.
void save_bodies(ArchiveWriter& archive, MPI_Comm communicator, const std::string& group,
                 const std::vector<BedGrain>& grains) {
  std::vector<double> bodies;
  for (const BedGrain& grain : grains) {
    if (!grain.body) continue;
    const std::vector<double> columns = columns_of(*grain.body);
    bodies.insert(bodies.end(), columns.begin(), columns.end());
  }
  const RowRange share = RowRange::of_rows(static_cast<std::int64_t>(bodies.size() / body_columns), communicator);
  if (share.count > 0) archive.write(group + "/body", bodies, share.box(body_columns));
}

// The clumps of the ranks follow each other as their members do.
void load_bodies(io::Hdf5Reader& file, const std::string& group, Bed& bed, const Ranks& ranks) {
  std::vector<std::size_t> first;
  for (std::size_t n = 0; n < bed.grains.size(); ++n)
    if (bed.grains[n].clump >= 0 && (n == 0 || bed.grains[n].clump != bed.grains[n - 1].clump)) first.push_back(n);
  const RowRange share = ranks.range_of(static_cast<std::int64_t>(first.size()));
  const auto bodies = io::read_column<double>(file, group + "/body", share, body_columns);
  for (std::size_t n = 0; n < first.size(); ++n) {
    const double* b = &bodies[n * body_columns];
    bed.grains[first[n]].body =
        std::make_shared<const BedBody>(BedBody{b[0], Vec3(b + 1), Vec3(b + 4), {b[7], b[8], b[9], b[10]}});
  }
}

// The rows of this rank come after those of lower ranks. Velocities are not kept, only the largest speed, for the
// watchdog.
void save_bed(ArchiveWriter& archive, MPI_Comm communicator, const std::string& group,
              const beds::Population& population) {
  const std::vector<BedGrain>& grains = population.file;
  std::vector<std::int64_t> clump;
  std::vector<double> radius, density, position;
  for (const BedGrain& grain : grains) {
    clump.push_back(grain.clump);
    radius.push_back(grain.radius);
    density.push_back(grain.density);
    position.insert(position.end(), grain.position.data(), grain.position.data() + 3);
  }
  const RowRange share = RowRange::of_rows(static_cast<std::int64_t>(grains.size()), communicator);
  archive.write(group + "/radius", radius, share.box());
  archive.write(group + "/density", density, share.box());
  archive.write(group + "/position", position, share.box(3));
  archive.write(group + "/clump", clump, share.box());
  save_bodies(archive, communicator, group, grains);
  archive.attribute(group + "/fastest", population.figures.fastest);
}

std::optional<Bed> load_bed(io::Hdf5Reader& file, const std::string& group, const Ranks& ranks) {
  if (!file.has(group + "/radius")) return std::nullopt;
  require_checksums(file);
  const auto rows = static_cast<std::int64_t>(file.shape(group + "/radius").at(0));
  const RowRange share = io::share_of_bed(file, group + "/clump", rows, ranks);
  const auto radius = io::read_column<double>(file, group + "/radius", share);
  const auto density = io::read_column<double>(file, group + "/density", share);
  const auto position = io::read_column<double>(file, group + "/position", share, 3);
  const auto clump = io::read_column<std::int64_t>(file, group + "/clump", share);
  Bed bed;
  bed.grains.reserve(radius.size());
  for (std::size_t n = 0; n < radius.size(); ++n)
    bed.grains.push_back({share.first + static_cast<GlobalId>(n), radius[n], density[n], Vec3(&position[3 * n]),
                          Vec3::Zero(), Vec3::Zero(), clump[n]});
  if (file.has(group + "/body")) load_bodies(file, group, bed, ranks);
  if (file.has(group + "/fastest")) bed.fastest = file.real_attribute(group + "/fastest");
  return bed;
}

}  // namespace

void save_beds(ArchiveWriter& archive, MPI_Comm communicator, const Case& c) {
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (c.grains[n].from_file()) save_bed(archive, communicator, group_of(n), c.grains[n]);
}

KnownBeds beds_of(std::vector<std::filesystem::path> checkpoints) {
  return [paths = std::move(checkpoints)](const Case& c, std::size_t population,
                                          const Ranks& ranks) -> std::optional<Bed> {
    for (const std::filesystem::path& path : paths) {
      try {
        io::Hdf5Reader file(ranks.communicator(), path);
        std::optional<Bed> bed = load_bed(file, group_of(population), ranks);
        if (bed) {  // of the rows alone, which have been taken for this box before
          bed->box = c.domain.size;
          bed->periodic = periodic_axes(c.domain);
          bed->disk_thickness = c.disks ? c.disks->thickness : 0.0;
        }
        return bed;
      } catch (const DamagedFile&) {  // the run will say so
      }
    }
    return std::nullopt;
  };
}

}  // namespace thalweg::driver
