// Signals as requests to stop cleanly: SIGTERM and SIGINT (mpirun and batch systems send them before they kill),
// SIGUSR1 (which mpirun passes on to every rank at once), SIGUSR2, and SIGHUP, when a terminal closes, unless it is
// ignored (nohup).
#pragma once

#include <string>

namespace thalweg::loop {

// Makes these signals end the process at once with this exit code from now on, until listen_for_stop_signals(): a run
// that has written nothing has nothing to save, and preparing it may take longer than the time before it is killed.
// says_so: with a sentence on standard error. SIGPIPE is ignored: losing the reader of our output must not end the run.
void end_on_stop_signals(int exit_code, bool says_so);

// Makes these signals set a flag from now on, and clears it. Under Open MPI's mpirun SIGCONT sets a flag too; where it
// has come since end_on_stop_signals(), waits first for the SIGTERM that follows.
void listen_for_stop_signals();

// Number of the last stop signal that this process has received since then; 0: none.
int received_stop_signal();

// Delay (s) between SIGCONT and SIGTERM; 0 if Open MPI's mpirun did not start this process. On SIGTERM and Ctrl-C,
// mpirun sends SIGCONT to every rank at once, SIGTERM after its odls_base_sigkill_timeout (Open MPI 5: a quarter of a
// second), and SIGKILL after the same delay again.
double sigcont_to_sigterm_delay();

// True if SIGCONT has come since the last call. (A suspended run that is resumed receives it as well.)
bool consume_sigcont();

// Name of a signal: "SIGTERM" for SIGTERM.
std::string signal_name(int signal);

}  // namespace thalweg::loop
