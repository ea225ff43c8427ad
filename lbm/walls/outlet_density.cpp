#include "lbm/walls/outlet_density.hpp"

#include <algorithm>
#include <numbers>

namespace thalweg::lbm {

namespace {

constexpr double speed_of_sound = std::numbers::inv_sqrt3;
constexpr double passages = 5.0;  // of sound through the box, in T

}  // namespace

OutletDensity::OutletDensity(double asked_for, int cells_across)
    : asked_for_(asked_for), memory_(passages * cells_across / speed_of_sound) {}

double OutletDensity::deviation() const {
  return asked_for_ + (mean_momentum_ ? (momentum_ - *mean_momentum_) / speed_of_sound : 0.0);
}

double OutletDensity::entering_speed() const { return std::max(0.0, -mean_momentum_.value_or(0.0)); }

void OutletDensity::update(double mean_momentum) {
  momentum_ = mean_momentum;
  if (!mean_momentum_) mean_momentum_ = mean_momentum;
  *mean_momentum_ += (mean_momentum - *mean_momentum_) / memory_;
}

void OutletDensity::save(ArchiveWriter& archive, const std::string& path) const {
  if (!mean_momentum_) return;
  archive.attribute(path + "_momentum", momentum_);
  archive.attribute(path + "_mean_momentum", *mean_momentum_);
}

void OutletDensity::load(ArchiveReader& archive, const std::string& path) {
  if (!archive.has(path + "_momentum")) return;
  momentum_ = archive.real_attribute(path + "_momentum");
  mean_momentum_ = archive.real_attribute(path + "_mean_momentum");
}

}  // namespace thalweg::lbm
