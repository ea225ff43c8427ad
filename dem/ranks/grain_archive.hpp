// Rows of grains and clumps in a saved state: the datasets that grain_dynamics_archive.cpp lists.
#pragma once

#include "core/base/archive.hpp"
#include "core/parallel/row_range.hpp"
#include "dem/clumps/clumps.hpp"
#include "dem/ranks/grain_batch.hpp"

#include <string>
#include <vector>

namespace thalweg::dem {

// Writes rows, in order of id through the ranks, below `group`. share: those of this rank; with_ids: where ids have
// gaps. Collective.
void write_grains(ArchiveWriter& archive, const std::string& group, const GrainBatch& batch, const RowRange& share,
                  int attached_width, bool with_ids, bool with_clumps);
void write_clumps(ArchiveWriter& archive, const std::string& group, std::vector<ClumpRow> rows, const RowRange& share);

// Reads these rows. Collective.
GrainBatch read_grains(ArchiveReader& archive, const std::string& group, const RowRange& share, int attached_width);
std::vector<ClumpRow> read_clumps(ArchiveReader& archive, const std::string& group, const RowRange& share);

}  // namespace thalweg::dem
