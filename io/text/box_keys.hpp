// A box with faces along the axes, as outputs name a part of the domain.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"

namespace thalweg::io {

struct BoxKeys {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  // m, corners
  bool operator==(const BoxKeys&) const = default;
};

inline void describe(SectionVisitor& visit, BoxKeys& box) {
  visit.vec3("lower", box.lower, {.unit = "m", .meaning = "lower corner", .required = true, .example = 0.0});
  visit.vec3("upper", box.upper, {.unit = "m", .meaning = "upper corner", .required = true, .example = 0.01});
}

}  // namespace thalweg::io
