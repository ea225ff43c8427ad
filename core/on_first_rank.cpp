#include "core/on_first_rank.hpp"

#include "core/error.hpp"
#include "core/mpi_session.hpp"

#include <string>

namespace thalweg {

void on_first_rank(MPI_Comm communicator, const std::function<void()>& work) {
  enum Outcome : int { well, input_error, run_error };
  int outcome = well;
  std::string message;
  if (rank_of(communicator) == 0) {
    try {
      work();
    } catch (const InputError& error) {
      outcome = input_error;
      message = error.what();
    } catch (const std::exception& error) {
      outcome = run_error;
      message = error.what();
    }
  }
  int header[2] = {outcome, static_cast<int>(message.size())};
  MPI_Bcast(header, 2, MPI_INT, 0, communicator);
  if (header[0] == well) return;
  message.resize(static_cast<std::size_t>(header[1]));
  MPI_Bcast(message.data(), header[1], MPI_CHAR, 0, communicator);
  if (header[0] == input_error) throw InputError(message);
  throw RunError(message);
}

}  // namespace thalweg
