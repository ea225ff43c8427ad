#include "core/sums/wide_sums_over_ranks.hpp"

namespace thalweg {

// MPI adds no 128-bit integers: value = upper 2^32 + lower with 0 <= lower < 2^32, and either part leaves room for the
// other ranks'.
void sum_over_ranks(MPI_Comm communicator, std::span<WideSum> sums) {
  constexpr std::uint64_t lower_mask = 0xffffffff;
  std::vector<std::int64_t> parts;
  for (const WideSum& sum : sums) {
    const auto low = static_cast<std::uint64_t>(sum.low);
    parts.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(sum.high) << 32 | low >> 32));
    parts.push_back(static_cast<std::int64_t>(low & lower_mask));
  }
  MPI_Allreduce(MPI_IN_PLACE, parts.data(), static_cast<int>(parts.size()), MPI_INT64_T, MPI_SUM, communicator);
  for (std::size_t s = 0; s < sums.size(); ++s) {
    const std::int64_t upper = parts[2 * s];
    sums[s] = {upper >> 32, static_cast<std::int64_t>(static_cast<std::uint64_t>(upper) << 32)};
    sums[s].add(parts[2 * s + 1]);
  }
}

std::vector<WideSum> wide_sums_over_ranks(MPI_Comm communicator, std::span<const std::int64_t> sums) {
  std::vector<WideSum> wide(sums.size());
  for (std::size_t s = 0; s < sums.size(); ++s) wide[s].add(sums[s]);
  sum_over_ranks(communicator, wide);
  return wide;
}

std::vector<Vec3> vectors_over_ranks(MPI_Comm communicator, std::span<const FixedVec3> sums) {
  std::vector<std::int64_t> parts;
  for (const FixedVec3& sum : sums) parts.insert(parts.end(), {sum.x, sum.y, sum.z});
  const std::vector<WideSum> totals = wide_sums_over_ranks(communicator, parts);
  std::vector<Vec3> vectors(sums.size());
  for (std::size_t k = 0; k < totals.size(); ++k)
    vectors[k / 3][static_cast<int>(k % 3)] = totals[k].to_double(LatticeFixed::bits);
  return vectors;
}

}  // namespace thalweg
