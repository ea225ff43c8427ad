#include "dem/laws/contact_history.hpp"

#include "core/parallel/wide_rows.hpp"

#include <algorithm>
#include <numeric>

namespace thalweg::dem {

void ContactHistories::add(const ContactKey& key, std::span<const double> values) {
  keys_.push_back(key);
  values_.insert(values_.end(), values.begin(), values.end());
}

void ContactHistories::add(const ContactHistories& others) {
  keys_.insert(keys_.end(), others.keys_.begin(), others.keys_.end());
  values_.insert(values_.end(), others.values_.begin(), others.values_.end());
}

void ContactHistories::sort() {
  std::vector<std::size_t> order(size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [this](std::size_t a, std::size_t b) { return keys_[a] < keys_[b]; });
  ContactHistories sorted(width_);
  sorted.keys_.reserve(keys_.size());
  sorted.values_.reserve(values_.size());
  for (const std::size_t n : order)
    if (sorted.size() == 0 || sorted.keys_.back() != keys_[n]) sorted.add(keys_[n], values(n));
  *this = std::move(sorted);
}

ContactHistories ContactHistories::exchanged(MPI_Comm communicator, const std::vector<int>& destination) const {
  ContactHistories arrived(width_);
  arrived.keys_ = exchange_rows(communicator, keys_, destination);
  arrived.values_ = exchange_wide_rows(communicator, values_, width_, destination);
  return arrived;
}

}  // namespace thalweg::dem
