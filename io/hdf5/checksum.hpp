// A checksum of a dataset to which every rank adds its own box: the same whatever the ranks, and another one if a bit
// of any value changes or two values change places.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/counter_random.hpp"

#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace thalweg::io {

// The sum over a box of a hash of each value and its place in the dataset, modulo 2^64; those of all boxes add up to
// that of the dataset. values: as many as the box has, in its order.
template <typename Number>
std::uint64_t checksum(std::span<const Number> values, const ArrayBox& box) {
  using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
  if (values.empty()) return 0;
  const std::size_t axes = box.shape.size(), row = box.shape.back();
  std::vector<std::uint64_t> at(box.offset);  // of the present row's first value
  std::uint64_t sum = 0;
  for (std::size_t first = 0; first < values.size(); first += row) {
    std::uint64_t place = 0;
    for (std::size_t a = 0; a < axes; ++a) place = place * box.global_shape[a] + at[a];
    for (std::size_t n = 0; n < row; ++n)
      sum += finalised_bits(std::uint64_t{std::bit_cast<Bits>(values[first + n])} ^ (place + n) * golden_step);
    for (std::size_t a = axes - 1; a-- > 0;) {
      if (++at[a] < box.offset[a] + box.shape[a]) break;
      at[a] = box.offset[a];
    }
  }
  return sum;
}

// A number of a box: those of boxes that cover a dataset exactly once add up, modulo 2^64, to that of the dataset; with
// overlaps or gaps they do not, save by an improbable chance. The product over the axes of sum (i^3 + i^2 + 1).
inline std::uint64_t coverage(const std::vector<std::uint64_t>& offset, const std::vector<std::uint64_t>& shape) {
  __extension__ using Wide = unsigned __int128;
  const auto below = [](std::uint64_t n) {
    if (n == 0) return std::uint64_t{0};
    const Wide pairs = Wide{n} * (n - 1) / 2, squares = Wide{n} * (n - 1) * (2 * n - 1) / 6;
    return static_cast<std::uint64_t>(pairs * pairs + squares + n);
  };
  std::uint64_t product = 1;
  for (std::size_t a = 0; a < shape.size(); ++a) product *= below(offset[a] + shape[a]) - below(offset[a]);
  return product;
}

}  // namespace thalweg::io
