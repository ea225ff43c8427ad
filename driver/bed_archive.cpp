#include "driver/bed_archive.hpp"

#include "core/mpi_session.hpp"
#include "io/hdf5_archive.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

namespace thalweg::driver {

namespace {

std::string group_of(std::size_t population) { return fmt::format("bed_{}", population); }

// What rank 0 alone writes, and any rank reads: all of it.
ArrayBox whole(bool mine, std::uint64_t rows, std::uint64_t columns = 1) {
  if (columns == 1) return {{rows}, {0}, {mine ? rows : 0}};
  return {{rows, columns}, {0, 0}, {mine ? rows : 0, columns}};
}

void save_bed(ArchiveWriter& archive, bool mine, const std::string& group, const std::vector<BedGrain>& grains) {
  std::vector<std::int64_t> clump;
  std::vector<double> radius, density, position;
  for (const BedGrain& grain : grains) {
    if (!mine) break;
    clump.push_back(grain.clump);
    radius.push_back(grain.radius);
    density.push_back(grain.density);
    position.insert(position.end(), grain.position.data(), grain.position.data() + 3);
  }
  archive.write(group + "/radius", radius, whole(mine, grains.size()));
  archive.write(group + "/density", density, whole(mine, grains.size()));
  archive.write(group + "/position", position, whole(mine, grains.size(), 3));
  archive.write(group + "/clump", clump, whole(mine, grains.size()));
}

template <typename Number>
std::vector<Number> column(io::Hdf5Reader& file, const std::string& path, std::uint64_t rows, std::uint64_t width = 1) {
  std::vector<Number> values(rows * width);
  file.read(path, values, whole(true, rows, width));
  return values;
}

std::optional<Bed> load_bed(io::Hdf5Reader& file, const std::string& group) {
  if (!file.has(group + "/radius")) return std::nullopt;
  const std::uint64_t count = file.shape(group + "/radius").at(0);
  const auto radius = column<double>(file, group + "/radius", count);
  const auto density = column<double>(file, group + "/density", count);
  const auto position = column<double>(file, group + "/position", count, 3);
  const auto clump = column<std::int64_t>(file, group + "/clump", count);
  Bed bed;
  for (std::size_t n = 0; n < count; ++n)
    bed.grains.push_back({static_cast<GlobalId>(n), radius[n], density[n], Vec3(&position[3 * n]), Vec3::Zero(),
                          Vec3::Zero(), clump[n]});
  return bed;
}

}  // namespace

void save_beds(ArchiveWriter& archive, MPI_Comm communicator, const Case& c) {
  const bool mine = rank_of(communicator) == 0;
  for (std::size_t n = 0; n < c.grains.size(); ++n)
    if (!c.grains[n].file.empty()) save_bed(archive, mine, group_of(n), c.grains[n].file);
}

KnownBeds beds_of(std::vector<std::filesystem::path> checkpoints) {
  return [paths = std::move(checkpoints)](const Case& c, std::size_t population) -> std::optional<Bed> {
    for (const std::filesystem::path& path : paths) {
      try {
        io::Hdf5Reader file(path);
        std::optional<Bed> bed = load_bed(file, group_of(population));
        if (bed) {  // of the rows alone, which have been taken for this box before
          bed->box = c.domain.size;
          bed->periodic = periodic_axes(c.domain);
          bed->disk_thickness = c.disks ? c.disks->thickness : 0.0;
        }
        return bed;
      } catch (const io::DamagedFile&) {  // the run will say so
      }
    }
    return std::nullopt;
  };
}

}  // namespace thalweg::driver
