#include "io/hdf5/bed_file.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/rows_by_id.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/labelled_arrays.hpp"
#include "io/vtk/grain_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace thalweg::io {
namespace {

const std::string format = "thalweg bed 1";

// One grain on its way to the rank that writes it.
struct BedRow {
  GlobalId id, clump;
  double radius, density;
  double position[3], velocity[3], angular_velocity[3];
};

std::vector<BedRow> rows_of(const GrainView& grains) {
  std::vector<BedRow> rows(grains.id.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const GlobalId clump = grains.is_member(n) ? grains.clump[n] : -1;
    rows[n] = {grains.id[n], clump, grains.radius[n], density_of(grains, n), {}, {}, {}};
    std::copy_n(grains.position[n].data(), 3, rows[n].position);
    std::copy_n(grains.velocity[n].data(), 3, rows[n].velocity);
    std::copy_n(grains.angular_velocity[n].data(), 3, rows[n].angular_velocity);
  }
  return rows;
}

ArrayBox box_of(const RowRange& range, std::uint64_t columns) {
  return columns == 1 ? range.box() : range.box(columns);
}

class BedWriter {
public:
  // share: the grains whose rows this rank writes.
  BedWriter(MPI_Comm communicator, const std::filesystem::path& path, const RowRange& share)
      : archive_(communicator, path), labeller_(archive_), first_(rank_of(communicator) == 0), share_(share) {}

  // values: of the grains of the share.
  template <typename Number>
  void column(const std::string& name, const char* unit, const std::vector<Number>& values, std::uint64_t width = 1) {
    archive_.write("grains/" + name, values, box_of(share_, width));
    const std::vector<std::uint64_t> rows{share_.box().global_shape[0]};
    if (width == 1)
      labeller_.label("grains", name, rows, {unit, {"id"}, {}});
    else
      labeller_.label("grains", name, {rows[0], width}, {unit, {"id"}, {"x", "y", "z"}});
  }
  void scalars(const std::vector<BedRow>& rows, const std::string& name, const char* unit, double BedRow::*field) {
    std::vector<double> values;
    for (const BedRow& row : rows) values.push_back(row.*field);
    column(name, unit, values);
  }
  void vectors(const std::vector<BedRow>& rows, const std::string& name, const char* unit, double (BedRow::*field)[3]) {
    std::vector<double> values;
    for (const BedRow& row : rows) values.insert(values.end(), row.*field, row.*field + 3);
    column(name, unit, values, 3);
  }
  template <typename Number>
  void triple(const std::string& name, const char* unit, std::vector<Number> values) {
    if (!first_) values.clear();
    archive_.write("bed/" + name, values, {{3}, {0}, {values.size()}});
    labeller_.label("bed", name, {3}, {unit, {}, {"x", "y", "z"}});
  }
  Hdf5Writer& archive() { return archive_; }
  void close() {
    labeller_.name_dimensions();
    archive_.close();
  }

private:
  Hdf5Writer archive_;
  ArrayLabeller labeller_;
  bool first_;
  RowRange share_;
};

// Reads a few numbers on every rank.
template <typename Number>
std::vector<Number> read_all(Hdf5Reader& file, const std::string& path, std::int64_t count) {
  return read_column<Number>(file, path, RowRange(count, 1, 0));
}

void read_header(Hdf5Reader& file, Bed& bed) {
  bed.time = file.real_attribute("bed/time");
  bed.disk_thickness = file.real_attribute("bed/disk_thickness");
  const std::vector<double> box = read_all<double>(file, "bed/box", 3);
  const std::vector<std::int64_t> periodic = read_all<std::int64_t>(file, "bed/periodic", 3);
  for (int axis = 0; axis < 3; ++axis) {
    bed.box[axis] = box[static_cast<std::size_t>(axis)];
    bed.periodic[static_cast<std::size_t>(axis)] = periodic[static_cast<std::size_t>(axis)] != 0;
  }
}

}  // namespace

void write_bed_file(MPI_Comm communicator, const std::filesystem::path& path, const Snapshot& snapshot) {
  const std::vector<BedRow> rows = rows_by_id(communicator, rows_of(snapshot.grains),
                                              BlockShare(snapshot.grains.end_of_ids(), 1, size_of(communicator)));
  const PeriodicBox box = snapshot.decomposition->box();
  BedWriter writer(communicator, path, RowRange::of_rows(static_cast<std::int64_t>(rows.size()), communicator));
  writer.archive().attribute("bed/format", format);
  writer.archive().attribute("bed/time", snapshot.time);
  writer.archive().attribute("bed/disk_thickness", snapshot.grains.disk_thickness);
  writer.triple<double>("box", "m", {box.size[0], box.size[1], box.size[2]});
  writer.triple<std::int64_t>("periodic", "1", {box.periodic[0], box.periodic[1], box.periodic[2]});
  std::vector<std::int64_t> ids, clumps;
  for (const BedRow& row : rows) {
    ids.push_back(row.id);
    clumps.push_back(row.clump);
  }
  writer.column("id", "1", ids);
  if (snapshot.grains.clump_count > 0) writer.column("clump", "1", clumps);
  writer.scalars(rows, "radius", "m", &BedRow::radius);
  writer.scalars(rows, "density", "kg/m^3", &BedRow::density);
  writer.vectors(rows, "position", "m", &BedRow::position);
  writer.vectors(rows, "velocity", "m/s", &BedRow::velocity);
  writer.vectors(rows, "angular_velocity", "rad/s", &BedRow::angular_velocity);
  writer.close();
}

RowRange share_of_bed(Hdf5Reader& file, const std::string& clumps, std::int64_t rows, const Ranks& ranks) {
  RowRange share = ranks.share_of(rows);
  if (ranks.alone() || !file.has(clumps)) return share;
  RowRange before = share;  // the last row of the rank before
  before.first = std::max<std::int64_t>(0, share.first - 1);
  before.last = share.first;
  std::vector<std::int64_t> clump = read_column<std::int64_t>(file, clumps, before);
  const std::vector<std::int64_t> own = read_column<std::int64_t>(file, clumps, share);
  if (clump.empty()) clump.push_back(-1);
  clump.insert(clump.end(), own.begin(), own.end());
  const auto goes_on = [&clump, start = share.first](std::int64_t row) {
    const auto n = static_cast<std::size_t>(row - start);
    return clump[n + 1] >= 0 && clump[n + 1] == clump[n];
  };
  while (share.first < share.last && goes_on(share.first)) ++share.first;
  // The rows up to the next rank's first; of a rank without a beginning, none.
  std::vector<std::int64_t> begins(1, share.size() > 0 ? share.first : rows);
  begins = ranks.gathered(std::move(begins));
  begins.push_back(rows);
  const auto mine = begins.begin() + ranks.number();
  share.first = *mine;
  share.last = share.first == rows ? rows : *std::min_element(mine + 1, begins.end());
  return share;
}

Bed read_bed_file(const std::filesystem::path& path, const Ranks& ranks) {
  Hdf5Reader file(ranks.communicator(), path);
  if (!file.has("bed/format") || file.text_attribute("bed/format") != format)
    throw InputError(fmt::format("{} is an HDF5 file but not a bed file of this program.", path.string()));
  Bed bed;
  read_header(file, bed);
  const auto rows = static_cast<std::int64_t>(file.shape("grains/id").at(0));
  const RowRange share = share_of_bed(file, "grains/clump", rows, ranks);
  const auto id = read_column<std::int64_t>(file, "grains/id", share);
  const auto radius = read_column<double>(file, "grains/radius", share);
  const auto density = read_column<double>(file, "grains/density", share);
  const auto position = read_column<double>(file, "grains/position", share, 3);
  const auto velocity = read_column<double>(file, "grains/velocity", share, 3);
  const auto spin = read_column<double>(file, "grains/angular_velocity", share, 3);
  const auto clump = file.has("grains/clump") ? read_column<std::int64_t>(file, "grains/clump", share)
                                              : std::vector<std::int64_t>(id.size(), -1);
  bed.grains.reserve(id.size());
  for (std::size_t n = 0; n < id.size(); ++n)
    bed.grains.push_back(
        {id[n], radius[n], density[n], Vec3(&position[3 * n]), Vec3(&velocity[3 * n]), Vec3(&spin[3 * n]), clump[n]});
  return bed;
}

}  // namespace thalweg::io
