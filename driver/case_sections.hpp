// The keys of a case file: their names, units, meanings, ranges and defaults, described once for reading, writing and
// documenting.
#pragma once

#include "driver/case.hpp"
#include "io/section_visitor.hpp"

namespace thalweg {

void describe(io::SectionVisitor& visit, Case& c);
void describe(io::SectionVisitor& visit, DomainCase& domain);
void describe(io::SectionVisitor& visit, SolidCase& solid);
void describe(io::SectionVisitor& visit, FluidStatisticsCase& statistics);
void describe(io::SectionVisitor& visit, PopulationCase& grains);
void describe_contact(io::SectionVisitor& visit, ContactCase& contact, bool with_grains);

}  // namespace thalweg
