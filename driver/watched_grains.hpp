// What is recorded of single grains (analysis.tracks): its keys, and which grains it means.
#pragma once

#include "driver/case.hpp"
#include "io/section_visitor.hpp"
#include "io/yaml_document.hpp"

#include <vector>

namespace thalweg {

void describe(io::SectionVisitor& visit, TracksCase& tracks);

// Throws InputError with the place of a key that names a grain which is not there.
void check_watched_grains(const Case& c, const io::YamlDocument& document);

std::vector<GlobalId> tracked_grains(const Case& c);  // ids, ascending

}  // namespace thalweg
