// Signals as requests to stop in good order: SIGTERM and SIGINT (mpirun and batch systems send them before they kill),
// SIGUSR1 (which mpirun passes on to every rank at once) and SIGUSR2.
#pragma once

#include <string>

namespace thalweg::loop {

// From now on these signals only leave a note; earlier ones are forgotten.
void listen_for_stop_signals();

// Number of the last stop signal this process has received since then; 0: none.
int received_stop_signal();

// "SIGTERM" for SIGTERM, and so on.
std::string signal_name(int signal);

}  // namespace thalweg::loop
