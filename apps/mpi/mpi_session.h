#pragma once

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "vmech/apps/compare/process_pool.h"

namespace vmech {

/// The processes that mpirun started: the first one gives out tasks, the others work. Should one of
/// them end amid its task, mpirun ends them all.
class MpiSession {
 public:
  /// Joins the others; null in a process that mpirun did not start, or if it is the only one.
  /// @throws std::invalid_argument if what vmech needs of MPI cannot be loaded.
  static std::unique_ptr<MpiSession> Join();
  virtual ~MpiSession() = default;

  virtual bool is_worker() const = 0;
  /// In a worker: does tasks until there are no more.
  virtual void Serve(const Work& work) = 0;
  /// In the first process: as RunInProcesses.
  virtual void Run(const std::vector<std::string>& tasks, const Coordinator& coordinator) = 0;
};

/// What the library that sees MPI holds, as its variable vmech_join: joins the others.
using JoinFunction = std::unique_ptr<MpiSession> (*)();

/// How many processes Open MPI's mpirun started; 1 if it did not start this one.
inline int ProcessesOfMpirun() {
  const char* size = std::getenv("OMPI_COMM_WORLD_SIZE");
  return size == nullptr ? 1 : std::atoi(size);
}

}  // namespace vmech
