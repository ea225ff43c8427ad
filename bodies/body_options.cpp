#include "bodies/body_options.hpp"

namespace thalweg::bodies {

std::vector<NamedChoice<MomentumExchange>> choices_of(MomentumExchange) {
  return {{MomentumExchange::galilean_invariant, "galilean_invariant", "Wen et al. 2014"},
          {MomentumExchange::classical, "classical", "Mei et al. 2002"}};
}

std::vector<NamedChoice<WallDensity>> choices_of(WallDensity) {
  return {{WallDensity::local, "local", "of the fluid cell"},
          {WallDensity::reference, "reference", "of the fluid at rest"}};
}

std::vector<NamedChoice<LinkRule>> choices_of(LinkRule) {
  return {{LinkRule::bouzidi, "bouzidi", "Bouzidi et al. 2001"},
          {LinkRule::cli, "cli", "Ginzburg et al. 2008; with collision trt"}};
}

std::vector<NamedChoice<RefillRule>> choices_of(RefillRule) {
  return {{RefillRule::equilibrium, "equilibrium", ""},
          {RefillRule::grad, "grad", "with the mean stress of the neighbours"}};
}

}  // namespace thalweg::bodies
