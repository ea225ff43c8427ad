// Options of the bodies in the fluid and their links (interpolated_bounce_back.hpp).
#pragma once

#include "core/base/types.hpp"
#include "core/keys/named_choice.hpp"

#include <vector>

namespace thalweg::bodies {

enum class MomentumExchange { galilean_invariant, classical };
enum class LinkRule { bouzidi, cli };

// Their words in a case file (core/keys/section_visitor.hpp).
std::vector<NamedChoice<MomentumExchange>> choices_of(MomentumExchange);
std::vector<NamedChoice<LinkRule>> choices_of(LinkRule);

struct LinkOptions {
  MomentumExchange momentum_exchange = MomentumExchange::galilean_invariant;
  LinkRule rule = LinkRule::bouzidi;
  // Density of the fluid at rest, 1 + rest_gradient.(x - rest_middle): hydrostatic, or 1 everywhere.
  Vec3 rest_gradient = Vec3::Zero();  // of rho a cell
  Vec3 rest_middle = Vec3::Zero();    // cells
  double reference_density = 0.0;     // rho - 1; force and torque count only what exceeds it
};

struct BodyOptions {
  LinkOptions links;
  bool keep_covered_momentum = false;  // a body gets the momentum, relative to its own, of cells that it covers
  // Spheres whose momentum by height is counted apart as well; ascending.
  std::vector<GlobalId> obstacles = {};
};

}  // namespace thalweg::bodies
