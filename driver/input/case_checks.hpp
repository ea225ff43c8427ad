// Checks of a complete case that involve several keys.
#pragma once

#include "core/keys/key_error.hpp"
#include "driver/case/axes.hpp"
#include "driver/case/case.hpp"
#include "io/text/yaml_document.hpp"

#include <string>

namespace thalweg::driver {

// Calls a check that throws KeyError, and names the place of the key in the document.
void at_place(const io::YamlDocument& document, const std::string& section, const auto& check_section) {
  try {
    check_section();
  } catch (const KeyError& error) {
    throw document.error(section.empty() ? error.key : section + "." + error.key, error.what());
  }
}

// Asks for a whole number of cells along the first so many axes.
void check_whole_cells(const DomainCase& domain, int axes, const io::YamlDocument& document);

// Asks that solids are no longer than can be followed and, in a fluid, leave it some of the box: before the estimates,
// which take them apart.
void check_solid_room(const Case& c, const io::YamlDocument& document);

// The part of check_case() that asks for whole cells, and for cells and room for the grains: without them nothing can
// be estimated.
void check_box(const Case& c, const io::YamlDocument& document);

// Throws InputError at the first thing that cannot be, with the place of the key to change in the document.
void check_case(const Case& c, const io::YamlDocument& document);

// Checks of the sections of a column, before the box is derived from them.
void check_column(const Case& c, const io::YamlDocument& document);

}  // namespace thalweg::driver
