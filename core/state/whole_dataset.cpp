#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace thalweg {

DamagedFile damaged_dataset(const std::string& path, const std::string& what) {
  return DamagedFile(
      fmt::format("{}: {}, the file is damaged; take an earlier checkpoint, or write the file again.", path, what));
}

void require_shape(const ArchiveReader& archive, const std::string& path, const std::vector<std::uint64_t>& shape) {
  const std::vector<std::uint64_t> found = archive.shape(path);
  if (found != shape)
    throw damaged_dataset(path, fmt::format("the file holds {} values, but {} belong there", fmt::join(found, " x "),
                                            fmt::join(shape, " x ")));
}

bool has_all_or_none(const ArchiveReader& archive, std::initializer_list<std::string> paths) {
  const auto has = [&](const std::string& path) { return archive.has(path); };
  const auto missing = std::find_if_not(paths.begin(), paths.end(), has);
  if (missing == paths.end()) return true;
  if (const auto there = std::find_if(paths.begin(), paths.end(), has); there != paths.end())
    throw damaged_dataset(*missing, fmt::format("the file has no such data, but {}", *there));
  return false;
}

}  // namespace thalweg
