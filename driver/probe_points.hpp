// Where the fluid is probed (analysis.probes): keys, and the points they mean.
#pragma once

#include "core/section_visitor.hpp"
#include "driver/case.hpp"
#include "io/yaml_document.hpp"

#include <vector>

namespace thalweg {

void describe(SectionVisitor& visit, ProbeLineCase& line);
void describe(SectionVisitor& visit, ProbesCase& probes);

// Throws InputError with the place where there is no point, or one is outside the box.
void check_probes(const Case& c, const io::YamlDocument& document);

// The single points, then those of the lines; m.
std::vector<Vec3> probe_points(const ProbesCase& probes);

}  // namespace thalweg
