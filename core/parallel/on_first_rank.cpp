#include "core/parallel/on_first_rank.hpp"

#include "core/base/error.hpp"
#include "core/base/error_message.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace thalweg {

namespace {

enum Outcome : int { well, input_error, run_error };

// Outcome of `work` on this rank: which kind of exception it throws.
Outcome outcome_of(const std::function<void()>& work, std::string& message) {
  try {
    work();
  } catch (const InputError& error) {
    message = error.what();
    return input_error;
  } catch (const std::exception& error) {
    message = error_message(error);
    return run_error;
  }
  return well;
}

// Throws on every rank the exception of `rank`.
void throw_what_happened_on(int rank, MPI_Comm communicator, int outcome, std::string message) {
  int header[2] = {outcome, static_cast<int>(message.size())};
  MPI_Bcast(header, 2, MPI_INT, rank, communicator);
  if (header[0] == well) return;
  message.resize(static_cast<std::size_t>(header[1]));
  MPI_Bcast(message.data(), header[1], MPI_CHAR, rank, communicator);
  if (header[0] == input_error) throw InputError(message);
  throw RunError(message);
}

}  // namespace

void on_first_rank(MPI_Comm communicator, const std::function<void()>& work) {
  std::string message;
  const int outcome = rank_of(communicator) == 0 ? outcome_of(work, message) : well;
  throw_what_happened_on(0, communicator, outcome, message);
}

std::string told_by_first_rank(MPI_Comm communicator, const std::function<std::string()>& work) {
  if (communicator == MPI_COMM_NULL) return work();
  std::string text;
  on_first_rank(communicator, [&] { text = work(); });
  std::uint64_t size = text.size();
  MPI_Bcast(&size, 1, MPI_UINT64_T, 0, communicator);
  text.resize(size);
  constexpr std::uint64_t at_once = std::uint64_t{1} << 30;  // MPI counts in int
  for (std::uint64_t done = 0; done < size; done += at_once)
    MPI_Bcast(text.data() + done, static_cast<int>(std::min(at_once, size - done)), MPI_CHAR, 0, communicator);
  return text;
}

void on_all_ranks(MPI_Comm communicator, const std::function<void()>& work) {
  std::string message;
  const int outcome = outcome_of(work, message), ranks = size_of(communicator);
  int first = outcome == well ? ranks : rank_of(communicator);
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, communicator);
  if (first < ranks) throw_what_happened_on(first, communicator, outcome, message);
}

}  // namespace thalweg
