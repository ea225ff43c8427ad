// Latest states of a watched grain, each with its contacts.
#pragma once

#include "analysis/tools/grain_record.hpp"

#include <deque>
#include <vector>

namespace thalweg::analysis {

// A contact of a grain, or of the member of a clump, as it feels it.
struct Touch {
  GlobalId partner;                 // the other grain; -1 - w for wall w
  Vec3 arm;                         // m, from the centre of the sphere to the contact
  Vec3 force;                       // N, on it
  double distance;                  // m, from its centre to the partner's; of a wall, to the wall
  GlobalId member = -1;             // id of the member of a clump; -1: it is none
  Vec3 from_centre = Vec3::Zero();  // m, from the clump's centre to the member's

  bool loaded() const { return force.dot(arm) < 0.0; }  // it presses the grain
  bool is(const Touch& other) const { return partner == other.partner && member == other.member; }
  Vec3 point() const { return from_centre + arm; }  // m, from the centre of the grain or clump to the contact
  Vec3 partner_position(const Vec3& centre) const { return centre + from_centre + arm * (distance / arm.norm()); }
};

struct GrainSample {
  double time;         // s
  GrainRecord record;  // its positions go on where the grain leaves a periodic box
  std::vector<Touch> touches;

  Vec3 operator[](GrainRecord::Quantity q) const { return record[q]; }
};

using GrainRing = std::deque<GrainSample>;  // oldest first

// States as rows for messages: touches lie one after the other, as many as their samples say.
struct TouchRow {
  GlobalId id, partner, member;   // of the grain or clump, of what it touches, of the member
  std::array<double, 10> values;  // arm, force, distance, from_centre
};
struct SampleRow {
  GlobalId id;
  double time;  // s
  GrainRecord record;
  std::int64_t touches;
};

inline TouchRow row_of(GlobalId id, const Touch& t) {
  const Vec3 &a = t.arm, &f = t.force, &c = t.from_centre;
  return {id, t.partner, t.member, {a.x(), a.y(), a.z(), f.x(), f.y(), f.z(), t.distance, c.x(), c.y(), c.z()}};
}
inline Touch touch_of(const TouchRow& row) {
  const auto& v = row.values;
  return {row.partner, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, v[6], row.member, {v[7], v[8], v[9]}};
}

// Adds the rows of a grain's ring behind those there are.
inline void add_rows(GlobalId id, const GrainRing& ring, std::vector<SampleRow>& samples,
                     std::vector<TouchRow>& touches) {
  for (const GrainSample& sample : ring) {
    samples.push_back({id, sample.time, sample.record, static_cast<std::int64_t>(sample.touches.size())});
    for (const Touch& touch : sample.touches) touches.push_back(row_of(id, touch));
  }
}

// One sample again; `next` goes on to the touches of the next.
inline GrainSample sample_of(const SampleRow& row, std::vector<TouchRow>::const_iterator& next) {
  GrainSample sample{row.time, row.record, {}};
  for (std::int64_t n = 0; n < row.touches; ++n) sample.touches.push_back(touch_of(*next++));
  return sample;
}

}  // namespace thalweg::analysis
