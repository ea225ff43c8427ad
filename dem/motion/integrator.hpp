// Integrators of the motion in a sub-step.
#pragma once

#include "core/keys/named_choice.hpp"

#include <vector>

namespace thalweg::dem {

enum class Integrator { velocity_verlet, gear };
std::vector<NamedChoice<Integrator>> choices_of(Integrator);  // its words in a case file

}  // namespace thalweg::dem
