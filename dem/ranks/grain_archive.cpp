#include "dem/ranks/grain_archive.hpp"

#include "core/state/whole_dataset.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace thalweg::dem {

namespace {

constexpr const char* vector_names[GrainRow::vectors] = {
    "position", "velocity", "angular_velocity", "contact_force", "contact_torque", "load_force", "load_torque"};

// The columns of a clump: of whole numbers, and of reals with their width.
constexpr std::pair<const char*, std::int64_t ClumpRow::*> clump_numbers[] = {
    {"clump_id", &ClumpRow::id}, {"clump_members", &ClumpRow::members}, {"clump_motion", &ClumpRow::motion}};

struct RealColumn {
  const char* name;
  std::uint64_t width;
  double* (*values)(ClumpRow&);
};

constexpr RealColumn clump_reals[] = {
    {"clump_mass", 1, [](ClumpRow& row) { return &row.mass; }},
    {"clump_volume", 1, [](ClumpRow& row) { return &row.volume; }},
    {"clump_moments", 3, [](ClumpRow& row) -> double* { return row.moments; }},
    {"clump_orientation", 4, [](ClumpRow& row) -> double* { return row.orientation; }},
    {"clump_centre", 3, [](ClumpRow& row) -> double* { return row.centre; }},
    {"clump_velocity", 3, [](ClumpRow& row) -> double* { return row.velocity; }},
    {"clump_angular_momentum", 3, [](ClumpRow& row) -> double* { return row.angular_momentum; }},
    {"clump_angular_velocity", 3, [](ClumpRow& row) -> double* { return row.angular_velocity; }}};

}  // namespace

void write_grains(ArchiveWriter& archive, const std::string& group, const GrainBatch& batch, const RowRange& share,
                  int attached_width, bool with_ids, bool with_clumps) {
  std::vector<double> radius, mass, vectors;
  std::vector<std::int64_t> id, motion, material;
  for (const GrainRow& row : batch.rows) {
    id.push_back(row.id);
    radius.push_back(row.radius);
    mass.push_back(row.mass);
    motion.push_back(row.motion);
    material.push_back(row.material);
  }
  if (with_ids) archive.write(group + "/id", id, share.box());
  archive.write(group + "/radius", radius, share.box());
  archive.write(group + "/mass", mass, share.box());
  archive.write(group + "/motion", motion, share.box());
  archive.write(group + "/material", material, share.box());
  for (int v = 0; v < GrainRow::vectors; ++v) {
    vectors.clear();
    for (const GrainRow& row : batch.rows) vectors.insert(vectors.end(), row.value[v].begin(), row.value[v].end());
    archive.write(group + "/" + vector_names[v], vectors, share.box(3));
  }
  if (attached_width > 0) archive.write(group + "/attached", batch.attached, share.box(attached_width));
  if (!with_clumps) return;
  std::vector<std::int64_t> clump;
  vectors.clear();
  for (const GrainRow& row : batch.rows) {
    clump.push_back(row.clump);
    vectors.insert(vectors.end(), row.offset.begin(), row.offset.end());
  }
  archive.write(group + "/clump", clump, share.box());
  archive.write(group + "/offset", vectors, share.box(3));
}

GrainBatch read_grains(ArchiveReader& archive, const std::string& group, const RowRange& share, int attached_width) {
  const auto rows = static_cast<std::size_t>(share.last - share.first);
  GrainBatch batch;
  batch.rows.resize(rows);
  std::vector<double> radius(rows), mass(rows), vectors(3 * rows);
  std::vector<std::int64_t> id(rows), motion(rows), material(rows);
  if (archive.has(group + "/id"))
    archive.read(group + "/id", id, share.box());
  else
    std::iota(id.begin(), id.end(), share.first);
  archive.read(group + "/radius", radius, share.box());
  archive.read(group + "/mass", mass, share.box());
  archive.read(group + "/motion", motion, share.box());
  archive.read(group + "/material", material, share.box());
  for (std::size_t r = 0; r < rows; ++r) batch.rows[r] = {id[r], motion[r], material[r], radius[r], mass[r], {}};
  for (int v = 0; v < GrainRow::vectors; ++v) {
    archive.read(group + "/" + vector_names[v], vectors, share.box(3));
    for (std::size_t r = 0; r < rows; ++r)
      batch.rows[r].value[v] = {vectors[3 * r], vectors[3 * r + 1], vectors[3 * r + 2]};
  }
  batch.attached.resize(rows * attached_width);
  if (attached_width > 0) archive.read(group + "/attached", batch.attached, share.box(attached_width));
  if (!has_all_or_none(archive, {group + "/clump", group + "/clump_id"})) return batch;
  std::vector<std::int64_t> clump(rows);
  archive.read(group + "/clump", clump, share.box());
  archive.read(group + "/offset", vectors, share.box(3));
  for (std::size_t r = 0; r < rows; ++r) {
    batch.rows[r].clump = clump[r];
    batch.rows[r].offset = {vectors[3 * r], vectors[3 * r + 1], vectors[3 * r + 2]};
  }
  return batch;
}

void write_clumps(ArchiveWriter& archive, const std::string& group, std::vector<ClumpRow> rows, const RowRange& share) {
  std::sort(rows.begin(), rows.end(), [](const ClumpRow& a, const ClumpRow& b) { return a.id < b.id; });
  for (const auto& [name, field] : clump_numbers) {
    std::vector<std::int64_t> values;
    for (const ClumpRow& row : rows) values.push_back(row.*field);
    archive.write(group + "/" + name, values, share.box());
  }
  for (const RealColumn& column : clump_reals) {
    std::vector<double> values;
    for (ClumpRow& row : rows) values.insert(values.end(), column.values(row), column.values(row) + column.width);
    archive.write(group + "/" + column.name, values, share.box(column.width));
  }
}

std::vector<ClumpRow> read_clumps(ArchiveReader& archive, const std::string& group, const RowRange& share) {
  std::vector<ClumpRow> rows(static_cast<std::size_t>(share.last - share.first));
  for (const auto& [name, field] : clump_numbers) {
    std::vector<std::int64_t> values(rows.size());
    archive.read(group + "/" + name, values, share.box());
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r].*field = values[r];
  }
  for (const RealColumn& column : clump_reals) {
    std::vector<double> values(column.width * rows.size());
    archive.read(group + "/" + column.name, values, share.box(column.width));
    for (std::size_t r = 0; r < rows.size(); ++r)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(column.width * r), column.width, column.values(rows[r]));
  }
  return rows;
}

}  // namespace thalweg::dem
