#include "loop/stop_request.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace thalweg::loop {

namespace {

volatile std::sig_atomic_t received = 0;
volatile std::sig_atomic_t continued = 0;
volatile std::sig_atomic_t code_at_the_end = 0;
volatile std::sig_atomic_t says_the_end = 0;

extern "C" void end_at_once(int) {
  constexpr std::string_view sentence =
      "thalweg: stopped by a signal before the run began: nothing was written, and the same command starts it.\n";
  ssize_t written = 0;
  if (says_the_end != 0) written = write(STDERR_FILENO, sentence.data(), sentence.size());
  static_cast<void>(written);
  _exit(code_at_the_end);
}
extern "C" void note_signal(int signal) { received = signal; }
extern "C" void note_continuation(int) { continued = 1; }

void handle_stop_signals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // file writes and MPI's own calls go on undisturbed
  for (int signal : {SIGTERM, SIGINT, SIGUSR1, SIGUSR2}) sigaction(signal, &action, nullptr);
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  if (hang_up.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  continued = 0;
  action.sa_handler = note_continuation;
  if (sigcont_to_sigterm_delay() > 0.0) sigaction(SIGCONT, &action, nullptr);
}

constexpr double default_sigkill_timeout = 1.0;    // s, Open MPI 4
constexpr double sigkill_timeout_of_prrte = 0.25;  // s, Open MPI 5.0, which takes no other value

}  // namespace

void end_on_stop_signals(int exit_code, bool says_so) {
  code_at_the_end = exit_code;
  says_the_end = says_so ? 1 : 0;
  handle_stop_signals(end_at_once);
}

void listen_for_stop_signals() {
  constexpr double longest_delay = 0.5;  // s, of a signal
  if (consume_sigcont())                 // and SIGTERM will follow, or the run was suspended
    std::this_thread::sleep_for(std::chrono::duration<double>(sigcont_to_sigterm_delay() + longest_delay));
  received = 0;
  handle_stop_signals(note_signal);
}

int received_stop_signal() { return received; }

double sigcont_to_sigterm_delay() {
  if (std::getenv("OMPI_COMM_WORLD_RANK") == nullptr) return 0.0;
  if (std::getenv("PRTE_LAUNCHED") != nullptr) return sigkill_timeout_of_prrte;
  const char* given = std::getenv("OMPI_MCA_odls_base_sigkill_timeout");
  const double seconds = given == nullptr ? 0.0 : std::atof(given);
  return seconds > 0.0 ? seconds : default_sigkill_timeout;
}

bool consume_sigcont() {
  const bool came = continued != 0;
  continued = 0;
  return came;
}

std::string signal_name(int signal) {
  switch (signal) {
    case SIGTERM:
      return "SIGTERM";
    case SIGINT:
      return "SIGINT";
    case SIGUSR1:
      return "SIGUSR1";
    case SIGHUP:
      return "SIGHUP";
    case SIGUSR2:
      return "SIGUSR2";
    default:
      return fmt::format("signal {}", signal);
  }
}

}  // namespace thalweg::loop
