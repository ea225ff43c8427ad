#include "bodies/map/body_options.hpp"

namespace thalweg::bodies {

std::vector<NamedChoice<MomentumExchange>> choices_of(MomentumExchange) {
  return {{MomentumExchange::galilean_invariant, "galilean_invariant", "Wen et al. 2014"},
          {MomentumExchange::classical, "classical", "Mei et al. 2002"}};
}

std::vector<NamedChoice<LinkRule>> choices_of(LinkRule) {
  return {{LinkRule::bouzidi, "bouzidi", "Bouzidi et al. 2001"},
          {LinkRule::cli, "cli", "Ginzburg et al. 2008; with collision trt"}};
}

}  // namespace thalweg::bodies
