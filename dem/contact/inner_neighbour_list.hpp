// Inner neighbour list: the pairs of a neighbour list that are so near that their law may act soon. In a bed at rest
// nearly all of them do touch, so that a sub-step need not look at the others of the skin.
//
// A pair is near if its gap is below the range of the law (contact_law.hpp, or of lubrication.hpp) plus a margin. Two
// grains close a gap by at most the sum of what both move, so while no grain has moved by more than half the margin
// since the pairs were looked at, the law cannot act in the others. The motion is bounded by the largest speed of every
// sub-step times its length; a third is kept in reserve for members of rigid bodies, which turn within a step. Leaving
// out a pair in which the law does not act changes no bit.
#pragma once

#include <cstdint>
#include <vector>

namespace thalweg::dem {

struct NearPair {
  std::uint32_t first, second;  // slots
  std::uint32_t pair;           // number in the neighbour list
};

class InnerNeighbourList {
public:
  explicit InnerNeighbourList(double margin = 0.0) : margin_(margin) {}

  double margin() const { return margin_; }  // m
  // True if the whole list of pairs must be searched again.
  bool stale() const { return !known_ || 3.0 * moved_ > margin_; }

  // Starts a new search: the list is empty.
  void begin() {
    pairs_.clear();
    moved_ = 0.0;
    known_ = true;
  }
  void add(const NearPair& pair) { pairs_.push_back(pair); }
  const std::vector<NearPair>& pairs() const { return pairs_; }

  void grains_moved(double distance) { moved_ += distance; }  // m, at most, since the last call

private:
  double margin_;
  double moved_ = 0.0;
  bool known_ = false;
  std::vector<NearPair> pairs_;
};

}  // namespace thalweg::dem
