// The keys of a case file: their names, units, meanings, ranges and defaults, described once for reading, writing and
// documenting.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "driver/case/case.hpp"

namespace thalweg::driver {

void describe(SectionVisitor& visit, Case& c);
void describe_domain(SectionVisitor& visit, DomainCase& domain, bool with_fluid);
void describe(SectionVisitor& visit, SolidCase& solid);

}  // namespace thalweg::driver
