// Signals as requests to stop in good order: SIGTERM and SIGINT (mpirun and batch systems send them before they kill),
// SIGUSR1 (which mpirun passes on to every rank at once), SIGUSR2, and SIGHUP, when a terminal closes, unless it is
// ignored (nohup).
#pragma once

#include <string>

namespace thalweg::loop {

// From now on these signals only set a flag; earlier ones are forgotten. Under Open MPI's mpirun SIGCONT sets one too.
// SIGPIPE is ignored: that nobody reads the output any more is no reason to end a run.
void listen_for_stop_signals();

// Number of the last stop signal this process has received since then; 0: none.
int received_stop_signal();

// Open MPI's mpirun answers SIGTERM and Ctrl-C in three strokes: SIGCONT to every rank at once, SIGTERM after its
// odls_base_sigkill_timeout (Open MPI 5: a quarter of a second), SIGKILL after the same again. The time between two
// strokes in s; 0: this process was not started by it.
double seconds_between_strokes();

// Whether a first stroke has come since the last call. (A suspended run that is resumed gets the same signal.)
bool take_first_stroke();

// "SIGTERM" for SIGTERM, and so on.
std::string signal_name(int signal);

}  // namespace thalweg::loop
