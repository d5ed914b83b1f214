#include <stdexcept>

#include "vmech/apps/mpi_session.h"

namespace vmech {

std::unique_ptr<MpiSession> MpiSession::Join() {
  if (ProcessesOfMpirun() <= 1) return nullptr;
  throw std::invalid_argument(
      "vmech was built without MPI, so that mpirun would start the same work several times; "
      "install "
      "libopenmpi-dev and build again, or leave mpirun away and use --jobs");
}

}  // namespace vmech
