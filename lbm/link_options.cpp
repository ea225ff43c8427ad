#include "lbm/link_options.hpp"

namespace thalweg::lbm {

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

}  // namespace thalweg::lbm
