#include "vmech/apps/mpi/mpi_session.h"

// The C interface alone: the one for C++ is no longer part of MPI.
#define OMPI_SKIP_MPICXX
#include <mpi.h>

#include <optional>

namespace vmech {
namespace {

constexpr int kTask = 1, kAnswer = 2, kReady = 3, kEnd = 4;

void SendText(const std::string& text, int to, int tag) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD);
}

struct Message {
  std::string text;
  int from, tag;
};

Message Receive(int from) {
  MPI_Status status;
  MPI_Probe(from, MPI_ANY_TAG, MPI_COMM_WORLD, &status);
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  Message message{std::string(static_cast<size_t>(size), '\0'), status.MPI_SOURCE, status.MPI_TAG};
  MPI_Recv(message.text.data(), size, MPI_CHAR, message.from, message.tag, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return message;
}

class OpenMpiSession final : public MpiSession {
 public:
  OpenMpiSession() {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  ~OpenMpiSession() override {
    for (int worker = 1; rank_ == 0 && worker < size_; ++worker) SendText("", worker, kEnd);
    MPI_Finalize();
  }

  bool is_worker() const override { return rank_ > 0; }

  void Serve(const Work& work) override {
    SendText("", 0, kReady);
    for (Message task = Receive(0); task.tag != kEnd; task = Receive(0)) {
      work(task.text, [](const std::string& answer) { SendText(answer, 0, kAnswer); });
      SendText("", 0, kReady);
    }
  }

  void Run(const std::vector<std::string>& tasks, const Coordinator& coordinator) override {
    std::vector<std::optional<size_t>> task_of(static_cast<size_t>(size_));
    size_t next = 0;
    int busy = 0;
    while (next < tasks.size() || busy > 0) {
      const Message message = Receive(MPI_ANY_SOURCE);
      std::optional<size_t>& task = task_of[static_cast<size_t>(message.from)];
      if (message.tag == kAnswer) {
        coordinator.answer(*task, message.text);
        continue;
      }
      if (task) --busy;
      task.reset();
      if (next == tasks.size()) continue;
      task = next;
      SendText(tasks[next++], message.from, kTask);
      ++busy;
    }
  }

 private:
  int rank_ = 0, size_ = 1;
};

std::unique_ptr<MpiSession> Join() {
  return std::make_unique<OpenMpiSession>();
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::JoinFunction vmech_join = vmech::Join;
}
