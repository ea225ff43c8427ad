// Histories of contacts as plain values, for messages between ranks and for files: for each the ids of its bodies and n
// doubles, whose meaning only the law knows.
#pragma once

#include "core/base/types.hpp"

#include <mpi.h>

#include <compare>
#include <cstddef>
#include <span>
#include <vector>

namespace thalweg::dem {

// `second` is the higher id of two grains, -1 - w for wall w, or that of a touch with a solid (solid_key()).
struct ContactKey {
  GlobalId first, second;
  auto operator<=>(const ContactKey&) const = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 means its zero
};

class ContactHistories {
public:
  ContactHistories() = default;
  explicit ContactHistories(std::size_t width) : width_(width) {}

  std::size_t size() const { return keys_.size(); }
  std::size_t width() const { return width_; }  // doubles a contact
  const ContactKey& key(std::size_t n) const { return keys_[n]; }
  std::span<const double> values(std::size_t n) const { return {values_.data() + n * width_, width_}; }

  // values: width() doubles; others: of the same width.
  void add(const ContactKey& key, std::span<const double> values);
  void add(const ContactHistories& others);

  // Sorts by ids and drops repetitions.
  void sort();

  // Sends history n to rank destination[n]; returns what arrived here. Collective.
  ContactHistories exchanged(MPI_Comm communicator, const std::vector<int>& destination) const;

private:
  std::size_t width_ = 0;
  std::vector<ContactKey> keys_;
  std::vector<double> values_;
};

}  // namespace thalweg::dem
