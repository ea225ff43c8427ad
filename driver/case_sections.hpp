// The keys of a case file: their names, units, meanings, ranges and defaults, described once for reading, writing and
// documenting.
#pragma once

#include "driver/case.hpp"
#include "io/section_visitor.hpp"

namespace thalweg {

void describe(io::SectionVisitor& visit, Case& c);
void describe_domain(io::SectionVisitor& visit, DomainCase& domain, bool with_fluid);
void describe(io::SectionVisitor& visit, FluidCase& fluid);
void describe(io::SectionVisitor& visit, SolidCase& solid);
void describe(io::SectionVisitor& visit, FluidStatisticsCase& statistics);
void describe(io::SectionVisitor& visit, PopulationCase& grains);
void describe(io::SectionVisitor& visit, OscillationCase& oscillation);
void describe(io::SectionVisitor& visit, MotionCase& motion);
void describe(io::SectionVisitor& visit, WallCase& wall);
void describe_contact(io::SectionVisitor& visit, ContactCase& contact, bool with_grains);

}  // namespace thalweg
