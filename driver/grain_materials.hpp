// From the sections `contact` of a case to the materials of dem/.
#pragma once

#include "dem/material.hpp"
#include "driver/case.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace thalweg {

// Number 0 is the section `contact` itself; every population with a section of its own has one more, in their order,
// in which what is not given is that of `contact`.
std::vector<dem::ContactParameters> materials_of(const Case& c);
int material_of(const Case& c, std::size_t population);

// Empty: walls are of each grain's own material.
std::optional<dem::ContactParameters> wall_material_of(const ContactCase& contact);

}  // namespace thalweg
