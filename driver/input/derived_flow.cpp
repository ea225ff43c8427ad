#include "driver/input/derived_flow.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/case/case_sections.hpp"
#include "driver/case/preset.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/input/case_checks.hpp"
#include "io/text/section_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>

namespace thalweg::driver {

namespace {

constexpr double tall = 100.0;  // the first guess of the height over the sum of the other two lengths

const io::YamlNode* size_of(const io::YamlDocument& document) {
  const io::YamlNode* size = document.find("domain.size");
  return size && size->kind == io::YamlNode::Kind::list ? size : nullptr;
}

// The keys that a section flow asks for.
FlowFilledIn question_of(const io::YamlDocument& document) {
  const io::YamlNode* size = size_of(document);
  const bool shields = document.find("flow.shields_number"), depth = document.find("flow.depth");
  const bool slope = document.find("gravity.slope");
  if (!shields && !depth)
    throw document.error("flow", "the section is empty; give shields_number, for example 0.05, depth in m, or both");
  const FlowFilledIn question{size && size->items.size() == 2, shields && !(slope && !depth), {}, {}};
  if (document.find("gravity.vector"))
    throw document.error("gravity.vector", "the section flow sets the slope; give gravity.magnitude in m/s^2 instead");
  if (document.find("fluid.mean_velocity"))
    throw document.error("fluid.mean_velocity",
                         "the section flow drives the water by the slope; remove one of the two sections");
  if (depth && !question.height && size)
    throw document.error("flow.depth",
                         "the box has a height already; leave out the third number of domain.size, or this key");
  if (shields && depth && slope)
    throw document.error("gravity.slope",
                         "it follows from flow.shields_number and flow.depth; remove one of the three");
  if (shields && !depth && slope && !question.height)
    throw document.error("gravity.slope",
                         "it follows from flow.shields_number; remove one of the two, or leave out the "
                         "third number of domain.size for the depth to follow");
  if (question.height && !depth && !(shields && slope))
    throw document.error("domain.size",
                         "the height is missing; give a third number in m, flow.depth, or flow.shields_number with "
                         "gravity.slope");
  return question;
}

// A height cannot follow from grains that are counted by it.
void refuse_circles(const Case& c, const io::YamlDocument& document) {
  for (std::size_t n = 0; n < c.grains.size(); ++n) {
    const std::string key = fmt::format("grains.{}.solid_fraction", n);
    const beds::PlacementKeys& placement = c.grains[n].placement;
    if (document.find(key) && !placement.region)
      throw document.error(key,
                           "the height of the box follows from the grains and cannot give their number; give count, "
                           "fill, or placement.region");
    if (c.grains[n].held() && !placement.region && placement.positions.empty() && !placement.file)
      throw document.error(fmt::format("grains.{}.placement", n),
                           "these grains stay where they are put, all over the height of the box, which follows from "
                           "them; give placement.region");
  }
}

// The document with a height of the box where there is none, so that it can be read.
io::YamlDocument with_height(const io::YamlDocument& document) {
  io::YamlDocument tried = document;
  if (const io::YamlNode* given = size_of(document); given && given->items.size() == 2) {
    const std::vector<io::YamlNode>& size = given->items;
    const auto number = [&](const io::YamlNode& node) {
      char* end = nullptr;
      const double value = std::strtod(node.text.c_str(), &end);
      if (end != node.text.c_str() && *end == '\0' && value > 0.0 && std::isfinite(value)) return value;
      throw document.error("domain.size", "expected numbers in m above 0, for example [0.06, 0.0105]");
    };
    tried.complete(
        "domain.size",
        fmt::format("[{}, {}, {:.9g}]", size[0].text, size[1].text, tall * (number(size[0]) + number(size[1]))),
        "flow");
  }
  lay_preset_beneath(tried);
  return tried;
}

// Completes what is read of the document as far as its grains and solids make a bed.
void make_bed(Case& c, const io::YamlDocument& document, bool height_follows, const KnownBeds& known,
              const Ranks& ranks) {
  if (c.grains.empty()) throw document.error("flow", "there are no grains that could make a bed; remove the section");
  if (height_follows) refuse_circles(c, document);
  fill_in_grains(c, document, known, ranks);
  fill_in_surfaces(c, document, ranks);
  check_solid_room(c, document);
}

// Throws where the flow that the section asks for does not follow from a slope over a bed.
void refuse_other_flows(const Case& c, const FlowFilledIn& question, const io::YamlDocument& document) {
  if (!drives_flow(c, 0))
    throw document.error("flow",
                         "walls close the box along x, and no slope drives a flow; give domain.boundaries.x: "
                         "periodic");
  if (periodic_axes(c.domain)[2])
    throw document.error("flow",
                         "a box that is periodic along z has no bed; give domain.boundaries a bottom and a top, or "
                         "remove the section");
  if (!(gravity_vector(c.gravity).z() < 0.0))
    throw document.error("flow",
                         "without gravity the grains make no bed; give gravity.magnitude in m/s^2, or remove the "
                         "section");
  if (!c.flow->shields_number) return;
  if (walls_drive(c))
    throw document.error(
        "flow.shields_number",
        "a top or side wall that moves along x drives the water, too, and the stress on the bed does not "
        "follow from the slope; leave out this key, and give gravity.slope");
  if (inlet_sets_flow(c, 0))
    throw document.error("flow.shields_number",
                         "an inlet across x sets how much flows, and the stress on the bed does not follow from the "
                         "slope; leave out this key, or make domain.boundaries.x periodic");
  if (!question.slope && !(c.gravity.slope.value_or(0.0) > 0.0))
    throw document.error("gravity.slope",
                         "the depth follows from it and from flow.shields_number; give a slope above 0, downhill along "
                         "x, or flow.depth in its place");
}

// m, of the water that has the Shields number on the slope of the case.
double depth_for(const Case& c, const io::YamlDocument& document) {
  const double radius = hydraulic_radius_with(c, *c.flow->shields_number);
  const double depth = depth_of(c, radius);
  if (!std::isfinite(depth)) {
    const double width = c.domain.size.y(), largest = width / side_walls(c);
    throw document.error("flow.shields_number",
                         fmt::format("on a slope of {:g} between side walls {:g} m apart it stays below {:.3g} however "
                                     "deep the water; give a smaller number or a steeper gravity.slope",
                                     *c.gravity.slope, width, *c.flow->shields_number * largest / radius));
  }
  return depth;
}

double slope_of(const Case& c, double stress_height, double depth, const io::YamlDocument& document) {
  const double radius = hydraulic_radius(c, depth), sine = stress_height / radius;
  if (!(sine < 1.0))
    throw document.error(
        "flow.shields_number",
        fmt::format("under {:.3g} m of water no slope gives it; give a smaller number or more water", depth));
  return std::tan(std::asin(sine));
}

}  // namespace

FlowFilledIn derive_flow(io::YamlDocument& document, const KnownBeds& known, const Ranks& ranks) {
  if (!document.find("flow")) return {};
  const io::YamlDocument tried = with_height(document);
  Case c;
  io::read_document(tried, c);  // refuses misspelt keys, before any is missed
  const FlowFilledIn question = question_of(document);
  check_whole_cells(c.domain, question.height ? 2 : 3, document);
  make_bed(c, tried, question.height, known, ranks);
  refuse_other_flows(c, question, document);
  const ReferenceGrain grain = reference_grain(c);
  const double excess = grain.density / c.fluid.density - 1.0, bed = settled_height(c);
  if (excess <= neutral_density)
    throw document.error("flow", "the grains are no heavier than the fluid and make no bed; remove the section");

  // (s - 1) d tau*, the product of sine and hydraulic radius, m.
  const double stress_height = excess * grain.diameter * c.flow->shields_number.value_or(0.0);
  FlowFilledIn filled_in = question;
  std::vector<std::string> follows;
  double depth = c.domain.size.z() - bed;
  if (question.height) {
    if (!c.flow->depth) filled_in.shields_number = c.flow->shields_number;
    depth = c.flow->depth ? *c.flow->depth : depth_for(c, document);
    const double height = box_height(c, depth);
    depth = height - bed;
    const std::string size = fmt::format("[{:.9g}, {:.9g}, {:.9g}]", c.domain.size.x(), c.domain.size.y(), height);
    document.complete("domain.size", size, "flow");
    follows.push_back("domain.size: " + size);
  }
  if (!(depth > 0.0))
    throw document.error("domain.size", fmt::format("the settled bed of about {:.4g} m fills the box; give a greater "
                                                    "height in m",
                                                    bed));
  if (question.slope) {
    const std::string slope = fmt::format("{:.6g}", slope_of(c, stress_height, depth, document));
    document.complete("gravity.slope", slope, "flow");
    follows.push_back("gravity.slope: " + slope);
  }
  filled_in.text =
      fmt::format("{}, for {:.4g} m of water over a bed of {:.4g} m", fmt::join(follows, " and "), depth, bed);
  return filled_in;
}

}  // namespace thalweg::driver
