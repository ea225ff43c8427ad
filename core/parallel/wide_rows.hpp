// Rows of a number of values that is known only in the run, for messages between ranks.
#pragma once

#include "core/base/check.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace thalweg {

// Exchange like exchange_rows(), for rows of `width` values, one row after the other; one message to a rank. width: the
// same on all ranks. Frees the values before those of others arrive. Collective.
template <typename Value>
std::vector<Value> exchange_wide_rows(MPI_Comm communicator, std::vector<Value> values, std::size_t width,
                                      const std::vector<int>& destination) {
  static_assert(std::is_trivially_copyable_v<Value>);
  CHECK(values.size() == width * destination.size());
  if (width == 0 || size_of(communicator) == 1) return values;
  std::vector<detail::Parcel> parcels = detail::parcels_to(destination);
  std::vector<Value> packed(values.size());
  for (std::size_t row = 0; row < destination.size(); ++row) {
    detail::Parcel& parcel = detail::parcel_to(destination[row], parcels);
    const std::size_t to = parcel.first + parcel.count++;
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * width), width,
                packed.begin() + static_cast<std::ptrdiff_t>(to * width));
  }
  std::vector<Value>().swap(values);
  detail::exchange_parcels(communicator, parcels, packed.data(), sizeof(Value) * width, [&](std::size_t count) {
    values.resize(count * width);
    return values.data();
  });
  return values;
}

}  // namespace thalweg
