#include "vmech/apps/mpi/mpi_session.h"

#include <fmt/format.h>

#include <stdexcept>

#include "vmech/base/late_library.h"

namespace vmech {

std::unique_ptr<MpiSession> MpiSession::Join() {
  if (ProcessesOfMpirun() <= 1) return nullptr;
  static const LateLibrary library("mpi");
  if (library.loaded()) return library.Variable<JoinFunction>("vmech_join")();
  throw std::invalid_argument(
      fmt::format("{}; it is there if vmech is built where libopenmpi-dev is installed. Without it "
                  "mpirun would start the same work several times: leave mpirun away and use "
                  "--jobs",
                  library.error()));
}

}  // namespace vmech
