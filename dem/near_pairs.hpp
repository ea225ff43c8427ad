// Which pairs of a contact list are so near that they may touch soon: a list within the list. In a bed at rest nearly
// all of them do touch, so that a sub-step need not look at the others of the skin.
//
// A pair is near if its gap is below a range. Two grains close a gap by at most the sum of what both move, so while no
// grain has moved by more than half the range since the pairs were looked at, the others cannot touch. The motion is
// bounded by the largest speed of every sub-step times its length; a third is kept in reserve for members of rigid
// bodies, which turn within a step. Leaving out a pair that does not touch changes no bit.
#pragma once

#include <cstdint>
#include <vector>

namespace thalweg::dem {

struct NearPair {
  std::uint32_t first, second;  // slots
  std::uint32_t pair;           // number in the contact list
};

class NearPairs {
public:
  explicit NearPairs(double range = 0.0) : range_(range) {}

  double range() const { return range_; }  // m
  // Whether the list of pairs must be looked through as a whole.
  bool stale() const { return !known_ || 3.0 * moved_ > range_; }

  void begin() {
    pairs_.clear();
    moved_ = 0.0;
    known_ = true;
  }
  void add(const NearPair& pair) { pairs_.push_back(pair); }
  const std::vector<NearPair>& pairs() const { return pairs_; }

  void grains_moved(double distance) { moved_ += distance; }  // m, at most, since the last call
  void forget() { known_ = false; }

private:
  double range_;
  double moved_ = 0.0;
  bool known_ = false;
  std::vector<NearPair> pairs_;
};

}  // namespace thalweg::dem
