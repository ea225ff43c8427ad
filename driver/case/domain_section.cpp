#include "driver/case/case_sections.hpp"

#include <fmt/format.h>

namespace thalweg::driver {
namespace {

// The faces as the file names them: an axis at once, or each side.
struct BoundaryKeys {
  std::optional<coupling::FaceKeys> x, y, x_low, x_high, y_low, y_high, bottom, top;
};

BoundaryKeys keys_of(const std::array<coupling::FaceKeys, 6>& faces) {
  BoundaryKeys keys;
  if (faces[x_low] == faces[x_high]) {
    keys.x = faces[x_low];
  } else {
    keys.x_low = faces[x_low];
    keys.x_high = faces[x_high];
  }
  if (faces[y_low] == faces[y_high]) {
    keys.y = faces[y_low];
  } else {
    keys.y_low = faces[y_low];
    keys.y_high = faces[y_high];
  }
  keys.bottom = faces[bottom];
  keys.top = faces[top];
  return keys;
}

std::array<coupling::FaceKeys, 6> faces_of(const BoundaryKeys& keys) {
  std::array<coupling::FaceKeys, 6> faces;
  faces[x_low] = keys.x.value_or(keys.x_low.value_or(coupling::FaceKeys{}));
  faces[x_high] = keys.x.value_or(keys.x_high.value_or(coupling::FaceKeys{}));
  faces[y_low] = keys.y.value_or(keys.y_low.value_or(coupling::FaceKeys{}));
  faces[y_high] = keys.y.value_or(keys.y_high.value_or(coupling::FaceKeys{}));
  faces[bottom] = keys.bottom.value_or(coupling::FaceKeys{});
  faces[top] = keys.top.value_or(coupling::FaceKeys{});
  return faces;
}

const std::string face_forms =
    "periodic, no_slip, free_slip, law_of_the_wall, or with its numbers, for example {type: navier_slip, slip_length: "
    "1e-4} or {type: moving, velocity: [0.1, 0, 0]}";

void check_axis(SectionVisitor& visit, const std::string& axis, const std::optional<coupling::FaceKeys>& both,
                const std::optional<coupling::FaceKeys>& low, const std::optional<coupling::FaceKeys>& high) {
  const std::string low_key = axis + "_low", high_key = axis + "_high";
  visit.require(!both || (!low && !high), low ? low_key : high_key,
                fmt::format("the axis is given twice; give either {} or {} and {}", axis, low_key, high_key));
  if (both) return;
  visit.require(low || high, axis, fmt::format("these two faces are missing; give one of {}", face_forms));
  visit.require(low.has_value(), low_key, fmt::format("this face is missing; give one of {}", face_forms));
  visit.require(high.has_value(), high_key, fmt::format("this face is missing; give one of {}", face_forms));
}

bool half_periodic(const std::optional<coupling::FaceKeys>& a, const std::optional<coupling::FaceKeys>& b) {
  return a && b && (a->type == lbm::FaceType::periodic) != (b->type == lbm::FaceType::periodic);
}

}  // namespace

static void describe_boundaries(SectionVisitor& visit, BoundaryKeys& keys, bool with_fluid) {
  const auto face = [&](const std::string& key, std::optional<coupling::FaceKeys>& value, const std::string& meaning) {
    visit.section(key, value, {.meaning = meaning, .shorthand = "type", .in_full = with_fluid && key == "y"});
  };
  face("x", keys.x, "both faces across the stream; or x_low and x_high");
  face("x_low", keys.x_low, "the upstream face");
  face("x_high", keys.x_high, "the downstream face");
  face("y", keys.y, "both side faces; or y_low and y_high");
  face("y_low", keys.y_low, "the side face at y = 0");
  face("y_high", keys.y_high, "the side face at the far end of y");
  face("bottom", keys.bottom, "the floor");
  face("top", keys.top, "the lid or free surface");
  check_axis(visit, "x", keys.x, keys.x_low, keys.x_high);
  check_axis(visit, "y", keys.y, keys.y_low, keys.y_high);
  visit.require(keys.bottom.has_value(), "bottom", fmt::format("this face is missing; give one of {}", face_forms));
  visit.require(keys.top.has_value(), "top", fmt::format("this face is missing; give one of {}", face_forms));
  const std::string together = "an axis is periodic on both faces or on neither; make both faces periodic";
  visit.require(!half_periodic(keys.x_low, keys.x_high), "x_low", together);
  visit.require(!half_periodic(keys.y_low, keys.y_high), "y_low", together);
  visit.require(!half_periodic(keys.bottom, keys.top), "bottom", together);
  const std::pair<const char*, const std::optional<coupling::FaceKeys>*> by_axis[3][3] = {
      {{"x", &keys.x}, {"x_low", &keys.x_low}, {"x_high", &keys.x_high}},
      {{"y", &keys.y}, {"y_low", &keys.y_low}, {"y_high", &keys.y_high}},
      {{"bottom", &keys.bottom}, {"top", &keys.top}, {"top", &keys.top}}};
  for (int axis = 0; axis < 3 && with_fluid; ++axis)
    for (const auto& [key, face_there] : by_axis[axis]) {
      visit.require(!*face_there || !(*face_there)->oscillation, key,
                    "only dry grains have walls that swing; remove the oscillation");
      visit.require(
          !*face_there || (*face_there)->type != lbm::FaceType::moving || (*face_there)->velocity[axis] == 0.0, key,
          "a moving wall moves in its own plane; give it no velocity across, or make it a velocity_inlet");
    }
}

void describe_domain(SectionVisitor& visit, DomainCase& domain, bool with_fluid) {
  visit.vec3("size", domain.size,
             {.unit = "m",
              .meaning = "length streamwise (x), cross-stream (y), upwards (z); leave out the last where the section "
                         "flow gives the depth",
              .required = true,
              .above = 0.0,
              .example = 0.1,
              .fewest_numbers = 2});
  visit.real("spacing", domain.spacing,
             {.unit = "m",
              .meaning = "side of a cell, which divides every length; without a fluid only the grid by which the box "
                         "is divided among ranks",
              .required = true,
              .above = 0.0,
              .example = 0.5e-3});
  BoundaryKeys keys = keys_of(domain.faces);
  visit.section("boundaries", {.meaning = "type of each face: " + face_forms, .required = true},
                [&](SectionVisitor& inside) { describe_boundaries(inside, keys, with_fluid); });
  if (visit.reading()) domain.faces = faces_of(keys);
}

}  // namespace thalweg::driver
