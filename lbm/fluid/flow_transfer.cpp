#include "lbm/fluid/flow_transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace thalweg::lbm {

namespace {

// The saved cells that this rank's cells lie between, along one axis.
class SourceAxis {
public:
  // This rank has cells [lower, upper) of `here`, the archive `saved`.
  SourceAxis(int saved, int here, int lower, int upper, bool periodic)
      : saved_(saved), ratio_(static_cast<double>(saved) / here), periodic_(periodic) {
    const int first = below(lower), last = below(upper - 1) + 1;
    first_ = periodic ? first : std::max(first, 0);
    count_ = (periodic ? last : std::min(last, saved - 1)) - first_ + 1;
    if (count_ >= saved) first_ = 0, count_ = saved;
    first_ = wrapped(first_);
  }

  int count() const { return count_; }

  // Two stretches without a wrap between them, the second of which may be empty: where they begin in the archive, where
  // in this rank's part, and how long they are.
  struct Segment {
    int from, to, count;
  };
  std::array<Segment, 2> segments() const {
    const int straight = std::min(count_, saved_ - first_);
    return {{{first_, 0, straight}, {0, straight, count_ - straight}}};
  }

  // The neighbours of a cell of `here` in this rank's part, and the weight of the second.
  struct Between {
    int first, second;
    double weight;
  };
  Between between(int cell) const {
    const int left = below(cell);
    return {place(left), place(left + 1), (cell + 0.5) * ratio_ - 0.5 - left};
  }

private:
  int below(int cell) const { return static_cast<int>(std::floor((cell + 0.5) * ratio_ - 0.5)); }
  int wrapped(int cell) const { return (cell % saved_ + saved_) % saved_; }
  int place(int cell) const { return periodic_ ? wrapped(cell - first_) : std::clamp(cell, 0, saved_ - 1) - first_; }

  int saved_;
  double ratio_;
  bool periodic_;
  int first_ = 0, count_ = 0;
};

// Density and velocity (with the whole force) of the saved cells of this rank's part.
class SavedFlow {
public:
  template <typename Real>
  SavedFlow(const Fluid<Real>& fluid, ArchiveReader& archive)
      : shape_(archive.shape("fluid/populations_00")), axes_(axes_of(fluid, shape_)) {
    const auto n = [this](int axis) { return static_cast<std::size_t>(axes_[static_cast<std::size_t>(axis)].count()); };
    states_.resize(n(0) * n(1) * n(2));
    for (int i = 0; i < D3Q19::directions; ++i)
      for (const SourceAxis::Segment& z : axes_[2].segments())
        for (const SourceAxis::Segment& y : axes_[1].segments())
          for (const SourceAxis::Segment& x : axes_[0].segments()) add<Real>(archive, i, x, y, z);
    for (FluidState& s : states_) s.velocity /= 1.0 + s.density_deviation;
  }

  // State at the centre of a cell of the fluid, by its global coordinates.
  FluidState at(const Index3& cell) const {
    SourceAxis::Between between[3];
    for (std::size_t a = 0; a < 3; ++a) between[a] = axes_[a].between(cell[a]);
    FluidState mean;
    for (int corner = 0; corner < 8; ++corner) {
      int place[3];
      double weight = 1.0;
      for (int a = 0; a < 3; ++a) {
        const bool second = (corner >> a & 1) != 0;
        place[a] = second ? between[a].second : between[a].first;
        weight *= second ? between[a].weight : 1.0 - between[a].weight;
      }
      const FluidState& s = states_[index(place[0], place[1], place[2])];
      mean.density_deviation += weight * s.density_deviation;
      mean.velocity += weight * s.velocity;
    }
    return mean;
  }

private:
  template <typename Real>
  static std::array<SourceAxis, 3> axes_of(const Fluid<Real>& fluid, const std::vector<std::uint64_t>& saved) {
    const auto axis = [&](int a) {
      return SourceAxis(static_cast<int>(saved.at(static_cast<std::size_t>(2 - a))), fluid.decomposition().cells()[a],
                        fluid.block().lower[a], fluid.block().upper[a], fluid.decomposition().periodic()[a]);
    };
    return {axis(0), axis(1), axis(2)};
  }

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * axes_[1].count() + y) * axes_[0].count() + x;
  }

  // Adds direction i of a box to density and momentum. A rank whose box is empty reads along.
  template <typename Real>
  void add(ArchiveReader& archive, int i, const SourceAxis::Segment& x, const SourceAxis::Segment& y,
           const SourceAxis::Segment& z) {
    const auto whole = [](int n) { return static_cast<std::uint64_t>(n); };
    const std::string path = fmt::format("fluid/populations_{:02d}", i);
    const ArrayBox box{
        shape_, {whole(z.from), whole(y.from), whole(x.from)}, {whole(z.count), whole(y.count), whole(x.count)}};
    std::vector<Real> values(static_cast<std::size_t>(z.count) * y.count * x.count);
    archive.read(path, std::span<Real>(values), box);
    std::size_t next = 0;
    for (int c = 0; c < z.count; ++c)
      for (int b = 0; b < y.count; ++b)
        for (int a = 0; a < x.count; ++a, ++next) {
          const auto f = static_cast<double>(values[next]);
          FluidState& s = states_[index(x.to + a, y.to + b, z.to + c)];
          s.density_deviation += f;
          s.velocity += f * Vec3(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
        }
  }

  std::vector<std::uint64_t> shape_;
  std::array<SourceAxis, 3> axes_;
  std::vector<FluidState> states_;
};

}  // namespace

template <typename Real>
void transfer_flow(Fluid<Real>& fluid, ArchiveReader& archive, double velocity_unit) {
  const SavedFlow saved(fluid, archive);
  fluid.initialise([&](const Vec3& centre) {
    FluidState s = saved.at({static_cast<int>(centre.x()), static_cast<int>(centre.y()), static_cast<int>(centre.z())});
    s.density_deviation *= velocity_unit * velocity_unit;
    s.velocity *= velocity_unit;
    return s;
  });
}

template void transfer_flow(Fluid<float>&, ArchiveReader&, double);
template void transfer_flow(Fluid<double>&, ArchiveReader&, double);

}  // namespace thalweg::lbm
