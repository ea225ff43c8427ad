#include "driver/bed_archive.hpp"

#include "core/row_range.hpp"
#include "io/hdf5_archive.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

namespace thalweg::driver {

namespace {

std::string group_of(std::size_t population) { return fmt::format("bed_{}", population); }

// share: the grains that this rank writes.
void save_bed(ArchiveWriter& archive, const RowRange& share, const std::string& group,
              const std::vector<BedGrain>& grains) {
  std::vector<std::int64_t> clump;
  std::vector<double> radius, density, position;
  for (std::int64_t n = share.first; n < share.last; ++n) {
    const BedGrain& grain = grains[static_cast<std::size_t>(n)];
    clump.push_back(grain.clump);
    radius.push_back(grain.radius);
    density.push_back(grain.density);
    position.insert(position.end(), grain.position.data(), grain.position.data() + 3);
  }
  archive.write(group + "/radius", radius, share.box());
  archive.write(group + "/density", density, share.box());
  archive.write(group + "/position", position, share.box(3));
  archive.write(group + "/clump", clump, share.box());
}

template <typename Number>
std::vector<Number> column(io::Hdf5Reader& file, const std::string& path, std::uint64_t rows, std::uint64_t width = 1) {
  std::vector<Number> values(rows * width);
  const RowRange all(static_cast<std::int64_t>(rows), 1, 0);
  file.read(path, values, width == 1 ? all.box() : all.box(width));
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
  const int ranks = size_of(communicator), me = rank_of(communicator);
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const std::vector<BedGrain>& grains = c.grains[n].file;
    if (!grains.empty())
      save_bed(archive, RowRange(static_cast<std::int64_t>(grains.size()), ranks, me), group_of(n), grains);
  }
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
