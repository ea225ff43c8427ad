// A force on every grain or clump, by its position and motion, evaluated with the contacts in every sub-step.
#pragma once

#include "core/base/archive.hpp"
#include "core/state/system.hpp"
#include "dem/clumps/clumps.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <span>
#include <vector>

namespace thalweg::dem {

class GrainDynamics;

class ForceField {
public:
  virtual ~ForceField() = default;

  // Number of columns it keeps with every grain (GrainStore::attached), zero in a new one. Nobody else may attach any.
  virtual int attached_columns() const { return 0; }
  // m: a rank must know all grains whose centres are within this distance of the centre of a grain it owns.
  virtual double reach() const { return 0.0; }
  // Fills the columns that follow from the owned grains and clumps alone. Called before find_neighbours(), and before
  // ghosts are made, which get copies.
  virtual void fill_columns(GrainStore&, const Clumps&) {}
  // Slots and neighbours have changed: what depends on them must be found anew. skin: m, of the neighbour list; no
  // grain moves further than half of it before the next call.
  virtual void find_neighbours(const GrainStore& store, double skin, const Clumps& clumps) = 0;
  // After the contacts: sets the loads of owned grains and clumps, in the store and, with the body forces (N) added, in
  // `grains` and `clumps`.
  virtual void act(PackedGrainState& grains, GrainStore& store, Clumps& clumps, std::span<const Vec3> body_force) = 0;

  // A step of the system has ended (time: s). Collective, as are the next three.
  virtual void step_ended(const GrainDynamics&, double /*time*/) {}
  // Its own state, besides the columns it keeps with the grains.
  virtual std::vector<Diagnostic> diagnostics(double /*time*/) const { return {}; }
  virtual void save(ArchiveWriter&) const {}
  virtual void load(ArchiveReader&) {}
};

}  // namespace thalweg::dem
