#include "io/hdf5/bed_file.hpp"

#include "core/base/error.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/rows_by_id.hpp"
#include "io/hdf5/hdf5_archive.hpp"
#include "io/hdf5/labelled_arrays.hpp"
#include "io/vtk/grain_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace thalweg::io {
namespace {

const std::string format = "thalweg bed 1";
const std::vector<std::string> vector_components{"x", "y", "z"};

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

struct ClumpRow {
  GlobalId id;
  double volume;
  double position[3], moments[3], orientation[4];
};

std::vector<ClumpRow> clump_rows_of(const GrainView& grains) {
  std::vector<ClumpRow> rows;
  for (const ClumpState& clump : grains.clumps) {
    rows.push_back({clump.id, clump.volume, {}, {}, {}});
    const Vec3 moments = clump.moments / (clump.mass / clump.volume);
    std::copy_n(clump.position.data(), 3, rows.back().position);
    std::copy_n(moments.data(), 3, rows.back().moments);
    std::copy_n(clump.orientation.data(), 4, rows.back().orientation);
  }
  return rows;
}

ArrayBox box_of(const RowRange& range, std::uint64_t columns) {
  return columns == 1 ? range.box() : range.box(columns);
}

class BedWriter {
public:
  BedWriter(MPI_Comm communicator, const std::filesystem::path& path)
      : archive_(communicator, path),
        labeller_(archive_),
        communicator_(communicator),
        first_(rank_of(communicator) == 0) {}

  // The group that columns belong to from now on. rows: as many as this rank writes. Collective.
  void begin(const std::string& group, std::size_t rows) {
    group_ = group;
    share_ = RowRange::of_rows(static_cast<std::int64_t>(rows), communicator_);
  }

  // values: of the rows of this rank.
  template <typename Number>
  void column(const std::string& name, const char* unit, const std::vector<Number>& values,
              std::vector<std::string> components = {}) {
    const std::uint64_t width = std::max<std::size_t>(1, components.size());
    archive_.write(group_ + "/" + name, values, box_of(share_, width));
    std::vector<std::uint64_t> shape{share_.box().global_shape[0]};
    if (width > 1) shape.push_back(width);
    labeller_.label(group_, name, shape, {unit, {"id"}, std::move(components)});
  }
  template <typename Row>
  void numbers(const std::vector<Row>& rows, const std::string& name, GlobalId Row::*field) {
    std::vector<std::int64_t> values;
    for (const Row& row : rows) values.push_back(row.*field);
    column(name, "1", values);
  }
  template <typename Row>
  void scalars(const std::vector<Row>& rows, const std::string& name, const char* unit, double Row::*field) {
    std::vector<double> values;
    for (const Row& row : rows) values.push_back(row.*field);
    column(name, unit, values);
  }
  template <typename Row, std::size_t width>
  void vectors(const std::vector<Row>& rows, const std::string& name, const char* unit, double (Row::*field)[width]) {
    std::vector<double> values;
    for (const Row& row : rows) values.insert(values.end(), row.*field, row.*field + width);
    column(name, unit, values, width == 4 ? std::vector<std::string>{"w", "x", "y", "z"} : vector_components);
  }
  template <typename Number>
  void triple(const std::string& name, const char* unit, std::vector<Number> values) {
    if (!first_) values.clear();
    archive_.write("bed/" + name, values, {{3}, {0}, {values.size()}});
    labeller_.label("bed", name, {3}, {unit, {}, vector_components});
  }
  Hdf5Writer& archive() { return archive_; }
  void close() {
    labeller_.name_dimensions();
    archive_.close();
  }

private:
  Hdf5Writer archive_;
  ArrayLabeller labeller_;
  MPI_Comm communicator_;
  bool first_;
  std::string group_;
  RowRange share_{0, 1, 0};
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
  const BlockShare by_id(snapshot.grains.end_of_ids(), 1, size_of(communicator));
  const std::vector<BedRow> rows = rows_by_id(communicator, rows_of(snapshot.grains), by_id);
  const PeriodicBox box = snapshot.decomposition->box();
  BedWriter writer(communicator, path);
  writer.archive().attribute("bed/format", format);
  writer.archive().attribute("bed/time", snapshot.time);
  writer.archive().attribute("bed/disk_thickness", snapshot.grains.disk_thickness);
  writer.triple<double>("box", "m", {box.size[0], box.size[1], box.size[2]});
  writer.triple<std::int64_t>("periodic", "1", {box.periodic[0], box.periodic[1], box.periodic[2]});
  writer.begin("grains", rows.size());
  writer.numbers(rows, "id", &BedRow::id);
  if (snapshot.grains.clump_count > 0) writer.numbers(rows, "clump", &BedRow::clump);
  writer.scalars(rows, "radius", "m", &BedRow::radius);
  writer.scalars(rows, "density", "kg/m^3", &BedRow::density);
  writer.vectors(rows, "position", "m", &BedRow::position);
  writer.vectors(rows, "velocity", "m/s", &BedRow::velocity);
  writer.vectors(rows, "angular_velocity", "rad/s", &BedRow::angular_velocity);
  if (snapshot.grains.clump_count > 0) {
    const std::vector<ClumpRow> clumps = rows_by_id(communicator, clump_rows_of(snapshot.grains), by_id);
    writer.begin("clumps", clumps.size());
    writer.numbers(clumps, "id", &ClumpRow::id);
    writer.scalars(clumps, "volume", "m^3", &ClumpRow::volume);
    writer.vectors(clumps, "position", "m", &ClumpRow::position);
    writer.vectors(clumps, "moments", "m^5", &ClumpRow::moments);
    writer.vectors(clumps, "orientation", "1", &ClumpRow::orientation);
  }
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

namespace {

// Throws InputError for what no clump can have.
void check_body(const BedBody& body, GlobalId clump) {
  const auto& [w, x, y, z] = body.orientation;
  constexpr double rounding = 1e-6;
  const bool good = body.volume > 0.0 && std::isfinite(body.volume) && body.from_first.allFinite() &&
                    body.moments.allFinite() && body.moments.minCoeff() > 0.0 &&
                    std::abs(w * w + x * x + y * y + z * z - 1.0) < rounding;
  if (!good)
    throw InputError(
        fmt::format("clump {} of the file has a volume of {:g} m^3 and moments of {:g}, {:g} and {:g} m^5; all must be "
                    "positive and finite, and its orientation a unit quaternion",
                    clump, body.volume, body.moments[0], body.moments[1], body.moments[2]));
}

// Gives the first member of every clump its body. The clumps of the ranks follow each other as their members do.
void read_bodies(Hdf5Reader& file, Bed& bed, const Ranks& ranks) {
  std::vector<BedGrain*> first;
  for (std::size_t n = 0; n < bed.grains.size(); ++n)
    if (bed.grains[n].clump >= 0 && (n == 0 || bed.grains[n].clump != bed.grains[n - 1].clump))
      first.push_back(&bed.grains[n]);
  const RowRange share = ranks.range_of(static_cast<std::int64_t>(first.size()));
  if (file.shape("clumps/id").at(0) != static_cast<std::uint64_t>(share.count))
    throw InputError(fmt::format("The bed file has {} rows of clumps, and its grains belong to {}.",
                                 file.shape("clumps/id").at(0), share.count));
  const auto id = read_column<std::int64_t>(file, "clumps/id", share);
  const auto volume = read_column<double>(file, "clumps/volume", share);
  const auto position = read_column<double>(file, "clumps/position", share, 3);
  const auto moments = read_column<double>(file, "clumps/moments", share, 3);
  const auto orientation = read_column<double>(file, "clumps/orientation", share, 4);
  const PeriodicBox box{bed.box, bed.periodic};
  ranks.on_all([&] {
    for (std::size_t n = 0; n < first.size(); ++n) {
      if (id[n] != first[n]->clump)
        throw InputError(
            fmt::format("The bed file has a row for clump {} where that of {} should be.", id[n], first[n]->clump));
      const double* q = &orientation[4 * n];
      const BedBody body{volume[n],
                         box.difference(Vec3(&position[3 * n]), first[n]->position),
                         Vec3(&moments[3 * n]),
                         {q[0], q[1], q[2], q[3]}};
      check_body(body, id[n]);
      first[n]->body = std::make_shared<const BedBody>(body);
    }
  });
}

}  // namespace

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
  if (file.has("clumps/id")) read_bodies(file, bed, ranks);
  return bed;
}

}  // namespace thalweg::io
