#include "dem/laws/liquid_bridge.hpp"

#include <numbers>

namespace thalweg::dem {

LiquidBridge::LiquidBridge(const LiquidBridgeParameters& p)
    : strength_(2.0 * std::numbers::pi * p.surface_tension * std::cos(p.contact_angle)),
      inverse_volume_(1.0 / p.volume),
      rupture_((1.0 + 0.5 * p.contact_angle) * std::cbrt(p.volume)) {}

void check(const LiquidBridgeParameters& p) {
  require_not_negative("liquid_bridge.surface_tension", p.surface_tension, " N/m");
  require(p.contact_angle >= 0.0 && p.contact_angle < 0.5 * std::numbers::pi, "liquid_bridge.contact_angle",
          p.contact_angle, " rad", "at least 0 and below pi/2");
  require(std::isfinite(p.volume) && p.volume > 0.0, "liquid_bridge.volume", p.volume, " m^3", "positive");
}

}  // namespace thalweg::dem
