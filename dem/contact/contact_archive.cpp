#include "dem/contact/contact_archive.hpp"

#include "core/parallel/row_range.hpp"

#include <cstdint>
#include <vector>

namespace thalweg::dem {

namespace {

std::string ids_name(const std::string& group) { return group + "/contact_ids"; }
std::string part_name(const std::string& group, const HistoryPart& part) { return group + "/contact_" + part.name; }

}  // namespace

void write_histories(ArchiveWriter& archive, const std::string& group, const ContactHistories& histories,
                     std::span<const HistoryPart> parts, MPI_Comm communicator) {
  const RowRange share = RowRange::of_rows(static_cast<std::int64_t>(histories.size()), communicator);
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < histories.size(); ++n)
    ids.insert(ids.end(), {histories.key(n).first, histories.key(n).second});
  archive.write(ids_name(group), ids, share.box(2));
  std::size_t column = 0;
  for (const HistoryPart& part : parts) {
    std::vector<double> values;
    for (std::size_t n = 0; n < histories.size(); ++n) {
      const std::span<const double> of_part = histories.values(n).subspan(column, part.size);
      values.insert(values.end(), of_part.begin(), of_part.end());
    }
    archive.write(part_name(group, part), values, share.box(part.size));
    column += part.size;
  }
}

ContactHistories read_histories(ArchiveReader& archive, const std::string& group, std::span<const HistoryPart> parts,
                                std::int64_t walls, MPI_Comm communicator) {
  const RowRange share(static_cast<std::int64_t>(archive.shape(ids_name(group)).at(0)), size_of(communicator),
                       rank_of(communicator));
  const auto rows = static_cast<std::size_t>(share.size());
  std::vector<std::int64_t> ids(2 * rows);
  archive.read(ids_name(group), ids, share.box(2));
  std::vector<std::vector<double>> columns;
  for (const HistoryPart& part : parts) {
    columns.emplace_back(part.size * rows, 0.0);
    if (archive.has(part_name(group, part))) archive.read(part_name(group, part), columns.back(), share.box(part.size));
  }
  ContactHistories histories(doubles_of(parts));
  std::vector<double> values;
  for (std::size_t r = 0; r < rows; ++r) {
    if (-1 - ids[2 * r + 1] >= walls) continue;
    values.clear();
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const auto begin = columns[p].begin() + static_cast<std::ptrdiff_t>(r * parts[p].size);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(parts[p].size));
    }
    histories.add({ids[2 * r], ids[2 * r + 1]}, values);
  }
  return histories;
}

}  // namespace thalweg::dem
