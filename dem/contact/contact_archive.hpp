// The datasets of the contacts in a saved state: contact_ids (lower id; higher id, or what solid_key() says of walls
// and solids), and one for each part of the law's history, named after it: contact_spring. One row per contact, sorted
// by ids.
#pragma once

#include "core/base/archive.hpp"
#include "dem/laws/contact_history.hpp"
#include "dem/laws/contact_law.hpp"

#include <mpi.h>

#include <span>
#include <string>

namespace thalweg::dem {

// Writes the histories of all ranks, in order of rank, below `group`. parts: names and sizes of the parts of a history,
// in their order. Collective.
void write_histories(ArchiveWriter& archive, const std::string& group, const ContactHistories& histories,
                     std::span<const HistoryPart> parts, MPI_Comm communicator);

// An even share of the histories for each rank; parts that were not saved, because the law had none of them, are zero.
// walls: contacts with walls and solids from this number on are left out. Collective.
ContactHistories read_histories(ArchiveReader& archive, const std::string& group, std::span<const HistoryPart> parts,
                                std::int64_t walls, MPI_Comm communicator);

}  // namespace thalweg::dem
