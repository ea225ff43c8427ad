#include "coupling/solid_forces.hpp"

#include "core/error.hpp"
#include "core/mpi_session.hpp"
#include "core/wide_sums_over_ranks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::coupling {

std::vector<std::int64_t> SolidForces::over_ranks(std::vector<std::int64_t> sums) const {
  const std::vector<WideSum> totals = wide_sums_over_ranks(communicator_, sums);
  std::transform(totals.begin(), totals.end(), sums.begin(), [](const WideSum& total) { return total.narrowed(); });
  return sums;
}

std::vector<Vec3> SolidForces::in_vectors(const std::vector<std::int64_t>& sums) {
  std::vector<Vec3> forces;
  for (std::size_t k = 0; k < sums.size(); k += 3)
    forces.push_back(FixedVec3{sums[k], sums[k + 1], sums[k + 2]}.to_vec3());
  return forces;
}

void SolidForces::write(const std::vector<std::int64_t>& sums, ArchiveWriter& archive) const {
  const std::vector<std::uint64_t> shape{static_cast<std::uint64_t>(solids_), 3}, nothing{0, 0};
  const bool first = rank_of(communicator_) == 0;
  const std::span<const std::int64_t> values = sums;
  archive.write("solids/force", first ? values : values.first(0), {shape, nothing, first ? shape : nothing});
}

void SolidForces::load(ArchiveReader& archive) {
  const std::vector<std::uint64_t> shape{static_cast<std::uint64_t>(solids_), 3};
  if (!archive.has("solids/force") || archive.shape("solids/force") != shape)
    throw InputError(
        fmt::format("The checkpoint does not hold {} static solids as this case does; keep the list solids.", solids_));
  loaded_.assign(static_cast<std::size_t>(3 * solids_), 0);
  archive.read("solids/force", std::span<std::int64_t>(loaded_), {shape, {0, 0}, shape});
}

}  // namespace thalweg::coupling
