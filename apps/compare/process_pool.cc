#include "vmech/apps/compare/process_pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string_view>

namespace vmech {
namespace {

constexpr std::string_view kDone = "done";

/// Writes a line to a socket; false if nobody is at its other end.
bool Send(int socket, std::string_view text) {
  const std::string line = std::string(text) + "\n";
  for (size_t sent = 0; sent < line.size();) {
    const ssize_t count = send(socket, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    sent += static_cast<size_t>(count);
  }
  return true;
}

/// Lines that come through a socket.
class LineReader {
 public:
  explicit LineReader(int socket) : socket_(socket) {}

  /// Waits for more; false if the other end is closed.
  bool Receive() {
    char block[1 << 14];
    ssize_t count;
    do {
      count = recv(socket_, block, sizeof block, 0);
    } while (count < 0 && errno == EINTR);
    if (count <= 0) return false;
    text_.append(block, static_cast<size_t>(count));
    return true;
  }
  std::optional<std::string> Next() {
    const size_t end = text_.find('\n');
    if (end == text_.npos) return {};
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }

 private:
  int socket_;
  std::string text_;
};

/// The life of a worker: answers begin with '=', kDone ends a task, '!' and what went wrong a life.
[[noreturn]] void Serve(int socket, const Work& work) {
  LineReader tasks(socket);
  do {
    while (const std::optional<std::string> task = tasks.Next()) {
      try {
        work(*task, [&](const std::string& answer) {
          if (!Send(socket, "=" + answer)) _exit(1);
        });
      } catch (const std::exception& error) {
        Send(socket, fmt::format("!{}", error.what()));
        _exit(1);
      }
      if (!Send(socket, kDone)) _exit(1);
    }
  } while (tasks.Receive());
  _exit(0);
}

std::string ReasonOf(int status) {
  if (WIFSIGNALED(status)) {
    return fmt::format("its process was ended by signal {} ({})", WTERMSIG(status),
                       strsignal(WTERMSIG(status)));
  }
  return fmt::format("its process ended by itself, with exit code {}", WEXITSTATUS(status));
}

struct Task {
  size_t index;
  std::string text;
};

struct Worker {
  pid_t process;
  int socket;
  LineReader answers;
  std::optional<size_t> task;
  std::string fault;
};

class ProcessPool {
 public:
  ProcessPool(const std::vector<std::string>& tasks, const Work& work,
              const Coordinator& coordinator)
      : work_(work), foreman_(coordinator) {
    for (size_t i = 0; i < tasks.size(); ++i) open_.push_back({i, tasks[i]});
  }
  ~ProcessPool() {
    for (const Worker& worker : workers_) {
      kill(worker.process, SIGKILL);
      close(worker.socket);
      waitpid(worker.process, nullptr, 0);
    }
  }
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  void Run(size_t jobs) {
    while (!open_.empty() || busy_ > 0) {
      while (workers_.size() < jobs && workers_.size() < open_.size() + busy_) Start();
      for (Worker& worker : workers_) GiveTask(&worker);
      Listen();
    }
  }

 private:
  void Start() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) ThrowNoProcess();
    const pid_t parent = getpid();
    const pid_t process = fork();
    if (process < 0) ThrowNoProcess();
    if (process == 0) {
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(1);  // it ended meanwhile
      KeepOnly(ends[1]);
      Serve(ends[1], work_);
    }
    close(ends[1]);
    workers_.push_back({process, ends[0], LineReader(ends[0]), {}, {}});
  }

  /// Closes what is open but standard files and a socket: locks must end with the parent.
  static void KeepOnly(int socket) {
    close_range(STDERR_FILENO + 1, socket - 1, 0);
    close_range(socket + 1, ~0U, 0);
  }

  [[noreturn]] static void ThrowNoProcess() {
    throw std::runtime_error(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }

  void GiveTask(Worker* worker) {
    if (worker->task || open_.empty()) return;
    worker->task = open_.front().index;
    Send(worker->socket, open_.front().text);  // one that has died is found out by Listen
    open_.pop_front();
    ++busy_;
  }

  void Listen() {
    std::vector<pollfd> sockets;
    for (const Worker& worker : workers_) sockets.push_back({worker.socket, POLLIN, 0});
    if (poll(sockets.data(), sockets.size(), -1) < 0) return;  // interrupted
    for (size_t i = sockets.size(); i-- > 0;) {
      if (sockets[i].revents == 0) continue;
      if (workers_[i].answers.Receive()) {
        Hear(&workers_[i]);
      } else {
        Reap(i);
      }
    }
  }

  void Hear(Worker* worker) {
    while (const std::optional<std::string> line = worker->answers.Next()) {
      if (*line == kDone) {
        worker->task.reset();
        --busy_;
      } else if (line->starts_with('!')) {
        worker->fault = line->substr(1);
      } else {
        foreman_.answer(*worker->task, line->substr(1));
      }
    }
  }

  void Reap(size_t i) {
    Worker worker = std::move(workers_[i]);
    workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
    close(worker.socket);
    int status = 0;
    while (waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
    }
    if (!worker.task) return;
    --busy_;
    const std::string reason = worker.fault.empty() ? ReasonOf(status) : worker.fault;
    if (std::optional<std::string> instead = foreman_.lost(*worker.task, reason)) {
      open_.push_front({*worker.task, std::move(*instead)});
    }
  }

  const Work& work_;
  const Coordinator& foreman_;
  std::deque<Task> open_;
  std::vector<Worker> workers_;
  size_t busy_ = 0;
};

}  // namespace

void RunInProcesses(int jobs, const std::vector<std::string>& tasks, const Work& work,
                    const Coordinator& coordinator) {
  ProcessPool(tasks, work, coordinator).Run(static_cast<size_t>(jobs));
}

}  // namespace vmech
