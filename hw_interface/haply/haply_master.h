#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "vmech/base/triple_buffer.h"
#include "vmech/hw_interface/haply/haply_wire.h"
#include "vmech/hw_interface/masters/master.h"

namespace vmech {

class WebSocketClient;

/// Where an Inverse3 is reached, and how it is served.
struct HaplyOptions {
  int port = 10001;            ///< of the Inverse Service on this machine, in [1, 65535]
  double period = 1e-3;        ///< T at which states are asked for [s], in [2.5e-4, 0.1]
  double connect_timeout = 2;  ///< for the service's first message [s], in [0.01, 60]
  double link_timeout = 0.02;  ///< silence after which the link is lost [s], in [1e-3, 10]
  /// What is known of the device: Haply states nothing of its mass and damping. The peak is what
  /// this driver asks for at most.
  HandlePhysics linear{0, 0, 0, 0, /*peak=*/8, /*max_speed=*/2};

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// A Haply Inverse3, three freedoms with force, behind the maker's Inverse Service on this machine:
/// JSON over a WebSocket, no library of theirs. A VerseGrip gives orientation and buttons, the
/// first of which, held, closes the gripper.
///
/// The service answers each message with one state. A thread of the master's own sends the newest
/// force whenever the loop writes one and takes the answer, so that the loop never waits. When the
/// loop stops writing, the thread sends no force; when the process dies, nothing is sent at all,
/// and the service lets the device go. A link that is lost stays lost: no force comes back by
/// itself.
class HaplyMaster : public Master {
 public:
  /// @throws std::invalid_argument as Validate.
  explicit HaplyMaster(HaplyOptions options = {});
  ~HaplyMaster() override;

  /// Answers of the service that were none of its states.
  std::uint64_t malformed() const noexcept { return malformed_; }

 private:
  struct Wish {
    Vector3d force = Vector3d::Zero();
    std::int64_t until_ns = 0;  // of the steady clock
  };
  struct Sample {
    HaplySample state;
    std::int64_t at_ns = 0;  // of the steady clock
  };

  DeviceInfo OnConfigure() override;
  void OnShutdown() noexcept override;
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand& command) noexcept override;
  void Converse();
  void AwaitWish() const noexcept;
  Vector3d WishedForce() noexcept;
  bool TakeAnswer(std::string* text);
  void Tell(const Sample& sample, MasterState* state) noexcept;

  HaplyOptions options_;
  HaplyDevice device_;
  std::unique_ptr<WebSocketClient> socket_;
  TripleBuffer<Wish> wishes_{Wish{}};
  TripleBuffer<Sample> samples_{Sample{}};
  int bell_ = -1;  // rings when there is a wish
  std::atomic<bool> over_ = false, lost_ = false;
  std::atomic<std::uint64_t> malformed_ = 0;
  std::int64_t start_ns_ = 0, read_ns_ = 0;
  MasterState newest_;
  std::thread conversation_;
};

}  // namespace vmech
