#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vmech {

/// Spreads tasks over processes. Processes and not threads, since Ipopt must not run twice in one,
/// and because a solver that takes its process down must not take the others with it.
///
/// A task and an answer are one line of text each; a task may have any number of answers.

/// What a worker does: a task, and where its answers go.
using Emit = std::function<void(const std::string& answer)>;
using Work = std::function<void(const std::string& task, const Emit& emit)>;

/// What the one who gives out the tasks hears of the one at an index.
struct Coordinator {
  std::function<void(size_t index, const std::string& answer)> answer;
  /// The worker ended amid the task, for this reason: what is to be done instead, if anything.
  std::function<std::optional<std::string>(size_t index, const std::string& reason)> lost;
};

/// Does the tasks in `jobs` processes beside this one, and returns when all are done. A worker
/// ends with this process, even if that is killed.
/// @throws std::runtime_error if no process can be started; what the coordinator throws.
void RunInProcesses(int jobs, const std::vector<std::string>& tasks, const Work& work,
                    const Coordinator& coordinator);

}  // namespace vmech
