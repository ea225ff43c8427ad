// `thalweg info --csv`: the summaries of many runs as one table.
#pragma once

#include <string>
#include <vector>

namespace thalweg::driver {

// A heading and one row a run folder, or one for each run of a sweep's folder, as comma-separated values: `run` (as
// given), `state` (finished; the reason why not; or state_without_summary where there is no summary yet), then every
// number and text of summary.json, those of its groups as group.name [unit], without the times of phases and the
// provenance. Columns come in the order in which the runs have them; what a run lacks is empty. Throws InputError for a
// path that is no run folder, and for a damaged summary.
std::vector<std::string> info_table(const std::vector<std::string>& runs);

}  // namespace thalweg::driver
