// A box with faces along the axes, as outputs name a part of the domain.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/keys/key_error.hpp"
#include "core/keys/section_visitor.hpp"

#include <fmt/format.h>

namespace thalweg::io {

struct BoxKeys {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  // m, corners
  bool operator==(const BoxKeys&) const = default;
};

inline void describe(SectionVisitor& visit, BoxKeys& box) {
  visit.vec3("lower", box.lower, {.unit = "m", .meaning = "lower corner", .required = true, .example = 0.0});
  visit.vec3("upper", box.upper, {.unit = "m", .meaning = "upper corner", .required = true, .example = 0.01});
}

// Throws KeyError where the box reaches out of the domain; domain_size: m.
inline void check_in_domain(const BoxKeys& box, const Vec3& domain_size) {
  if ((box.lower.array() >= 0.0).all() && lies_in_box(box.upper, domain_size)) return;
  throw KeyError("box", fmt::format("the box reaches out of the domain; give corners in m between [0, 0, 0] and [{:g}, "
                                    "{:g}, {:g}]",
                                    domain_size[0], domain_size[1], domain_size[2]));
}

}  // namespace thalweg::io
