// What is recorded of single grains (analysis.tracks and analysis.entrainment): keys, and which grains they mean.
#pragma once

#include "core/section_visitor.hpp"
#include "driver/case.hpp"
#include "io/yaml_document.hpp"

#include <vector>

namespace thalweg {

void describe(SectionVisitor& visit, TracksCase& tracks);
void describe(SectionVisitor& visit, EntrainmentCase& entrainment);

// Throws InputError with the place of a key that names a grain which is not there, or asks for what cannot be watched.
void check_watched_grains(const Case& c, const io::YamlDocument& document);

std::vector<GlobalId> tracked_grains(const Case& c);  // ids, ascending
std::vector<GlobalId> watched_grains(const Case& c);  // of analysis.entrainment, the same; empty: those of the surface

}  // namespace thalweg
