// Whether a case that is complete can be run at all: what follows from several keys together.
#pragma once

#include "driver/case.hpp"
#include "io/yaml_document.hpp"

namespace thalweg {

// Throws InputError at the first thing that cannot be, with the place of the key to change in the document.
void check_case(const Case& c, const io::YamlDocument& document);

}  // namespace thalweg
