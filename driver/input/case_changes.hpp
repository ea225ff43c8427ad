// Differences between the case of a run and the case it is continued with.
#pragma once

#include <string>
#include <vector>

namespace thalweg::driver {

struct CaseChange {
  std::string key;          // e.g. "grains.0.density"
  std::string before, now;  // as written in the file; "none" where it has no such key
};

// Changes between two cases written by resolved_yaml(): in the order of the first, then new keys. Placement and initial
// are ignored, because a checkpoint holds the grains and the flow.
std::vector<CaseChange> case_changes(const std::string& before, const std::string& now);

// The keys of such a case that a checkpoint fixes (see below), a line "key: value" each. A checkpoint keeps them, so
// that it can be compared with a case wherever it lies.
std::string state_of_case(const std::string& yaml, bool dry);
// The changes from the text of state_of_case() to the case now, of those keys alone.
std::vector<CaseChange> state_changes(const std::string& before, const std::string& now, bool dry);

// Throws InputError, naming the first, if a change is of something that the checkpoint contains and the case cannot
// alter: the system, the box, the cells, their precision, the grains themselves, which populations have a contact
// section, how walls and held grains move. dry: whether it is a case without a fluid, whose outer walls may move out of
// their plane.
void refuse_changes_of_state(const std::vector<CaseChange>& changes, bool dry);

}  // namespace thalweg::driver
