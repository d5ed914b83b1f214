#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <thread>

#include "hw_interface/point_master.h"
#include "support/examples.h"
#include "vmech/hw_interface/remote/udp_server.h"

namespace vmech::udp_test {
namespace {

constexpr std::int64_t kTick = 1'000'000;  // [ns]

/// Stands between host and device and treats datagrams badly, in the time of the test.
class Relay {
 public:
  struct Faults {
    double loss = 0, duplication = 0, reordering = 0;
    int delay_ticks = 0;
  };
  explicit Relay(int server_port) : to_server_(ToSockaddr({"127.0.0.1", server_port})) {}

  int port() const { return towards_host_.port(); }

  void Step(const Faults& faults) {
    ++tick_;
    sockaddr_in from;
    while (const auto bytes = towards_host_.Receive(&from)) {
      host_ = from;
      Queue(*bytes, faults, &up_);
    }
    while (const auto bytes = towards_server_.Receive(&from)) Queue(*bytes, faults, &down_);
    Forward(&up_, &towards_server_, to_server_);
    Forward(&down_, &towards_host_, host_);
  }

 private:
  struct Waiting {
    int due;
    UdpPacket packet;
  };
  void Queue(std::span<const std::byte> bytes, const Faults& faults, std::deque<Waiting>* queue) {
    UdpPacket packet;
    if (!Decode(bytes, &packet) || random_.Between(0, 1) < faults.loss) return;
    const int copies = random_.Between(0, 1) < faults.duplication ? 2 : 1;
    const int later = random_.Between(0, 1) < faults.reordering ? 3 : 0;
    for (int i = 0; i < copies; ++i) queue->push_back({tick_ + faults.delay_ticks + later, packet});
  }
  void Forward(std::deque<Waiting>* queue, UdpSocket* through, const sockaddr_in& to) {
    for (auto it = queue->begin(); it != queue->end();) {
      if (it->due > tick_) {
        ++it;
        continue;
      }
      through->Send(it->packet, to);
      it = queue->erase(it);
    }
  }

  UdpSocket towards_host_{UdpAddress{}}, towards_server_{UdpAddress{}};
  sockaddr_in to_server_, host_{};
  std::deque<Waiting> up_, down_;
  int tick_ = 0;
  Random random_{23};
};

/// A remote point master with a host that pulls at it, through a relay.
class UdpPair : public testing::Test {
 protected:
  UdpPair() : device_(PointOptions{}) {
    device_.Configure();
    UdpServerOptions options;
    options.local.port = 0;
    server_ = std::make_unique<UdpServer>(options, &device_);
    relay_ = std::make_unique<Relay>(server_->port());
    UdpMasterOptions host;
    host.device.port = relay_->port();
    host_ = std::make_unique<UdpMaster>(host);
  }

  /// Configure waits for an answer, which the other end gives meanwhile.
  void Connect() {
    std::atomic<bool> connected = false;
    std::thread other_end([&] {
      while (!connected) {
        relay_->Step({});
        server_->Step(now_);
      }
    });
    host_->Configure();
    connected = true;
    other_end.join();
    host_->Activate();
  }

  void HostTick(double force) {
    status_ = host_->Read(now_, &state_);
    MasterCommand command;
    command.sequence = ++commands_;
    command.mode = CommandMode::kWrench;
    command.valid_until_ns = now_ + 5 * kTick;
    command.F_Ho_D[0] = force;
    (void)host_->Write(command);
  }
  void DeviceTick(const Relay::Faults& faults = {}) {
    relay_->Step(faults);
    server_->Step(now_);
    relay_->Step(faults);
    now_ += kTick;
  }

  PointMaster device_;
  std::unique_ptr<UdpServer> server_;
  std::unique_ptr<Relay> relay_;
  std::unique_ptr<UdpMaster> host_;
  MasterState state_;
  IoStatus status_ = IoStatus::kOk;
  std::int64_t now_ = 0;
  std::uint64_t commands_ = 0;
};

TEST_F(UdpPair, HostSeesTheDeviceAndItsPhysics) {
  Connect();
  EXPECT_EQ(host_->info().name, "point");
  EXPECT_EQ(host_->info().linear.damping, 2);
  EXPECT_TRUE(host_->info().takes_wrench);
}

TEST_F(UdpPair, ForceArrivesAndMotionComesBack) {
  Connect();
  for (int k = 0; k < 100; ++k) {
    HostTick(1);
    DeviceTick();
  }
  EXPECT_EQ(device_.force[0], 1);
  EXPECT_EQ(device_.lifecycle(), Lifecycle::kActive);
  EXPECT_GT(state_.X_DH.p.x(), 1e-3);
  EXPECT_NEAR(state_.X_DH.p.x(), device_.x[0], 1e-3);
  EXPECT_EQ(status_, IoStatus::kOk);
}

TEST_F(UdpPair, ForceIsGoneSoonAfterTheHostDies) {
  Connect();
  for (int k = 0; k < 20; ++k) {
    HostTick(1);
    DeviceTick();
  }
  std::vector<double> forces;
  for (int k = 0; k < 30; ++k) {
    DeviceTick();
    forces.push_back(device_.force[0]);
  }
  EXPECT_EQ(forces[3], 1);   // held
  EXPECT_GT(forces[10], 0);  // on its way down
  EXPECT_LT(forces[10], 0.7);
  EXPECT_EQ(forces[17], 0);  // 5 ms hold, 10 ms ramp
  EXPECT_EQ(device_.lifecycle(), Lifecycle::kInactive);
}

TEST_F(UdpPair, HostNoticesThatTheDeviceIsGone) {
  Connect();
  for (int k = 0; k < 20; ++k) {
    HostTick(1);
    DeviceTick();
  }
  for (int k = 0; k < 30; ++k) {
    HostTick(1);
    now_ += kTick;
  }
  EXPECT_EQ(status_, IoStatus::kLinkLost);
}

TEST_F(UdpPair, SurvivesLossDelayDuplicationAndReordering) {
  Connect();
  const Relay::Faults faults{0.1, 0.1, 0.1, 1};
  std::uint64_t last = 0;
  for (int k = 0; k < 2000; ++k) {
    HostTick(0.5);
    DeviceTick(faults);
    EXPECT_GE(state_.sequence, last);  // never back in time
    EXPECT_NE(status_, IoStatus::kLinkLost);
    last = state_.sequence;
  }
  EXPECT_EQ(device_.force[0], 0.5);
  const LinkStatistics& statistics = host_->statistics();
  EXPECT_GT(statistics.missing, 100u);
  EXPECT_GT(statistics.stale, 100u);
  EXPECT_EQ(statistics.malformed, 0u);
  EXPECT_GT(statistics.round_trip_ns, 0);
}

TEST_F(UdpPair, SecondHostIsIgnoredWhileTheFirstIsThere) {
  Connect();
  UdpMasterOptions options;
  options.device.port = server_->port();
  options.connect_timeout = 0.05;
  UdpMaster other(options);
  std::atomic<bool> done = false;
  std::thread other_end([&] {
    while (!done) server_->Step(now_);
  });
  EXPECT_THROW(other.Configure(), std::runtime_error);
  done = true;
  other_end.join();
}

TEST_F(UdpPair, ByeFreesTheDevice) {
  Connect();
  HostTick(1);
  DeviceTick();
  host_->Shutdown();
  DeviceTick();
  EXPECT_FALSE(server_->serves());
  EXPECT_EQ(device_.lifecycle(), Lifecycle::kInactive);
}

/// A host that is out of its mind: the server answers for the device.
TEST_F(UdpPair, ForceNeverExceedsWhatTheDeviceStates) {
  Connect();
  for (int k = 0; k < 100; ++k) {
    HostTick(1e6);
    DeviceTick();
    EXPECT_LE(std::abs(device_.force[0]), 20);  // its peak
  }
  EXPECT_EQ(device_.force[0], 20);
}

TEST_F(UdpPair, HandleThatIsTooFastLosesTheForceUntilTheHostHasLetGo) {
  Connect();
  device_.v[0] = 6;  // it states 5 m/s
  bool tripped = false;
  for (int k = 0; k < 40; ++k) {
    HostTick(1);
    DeviceTick();
    if (tripped) EXPECT_EQ(device_.force[0], 0);  // in the period after
    tripped |= server_->tripped() == ForceOff::kSpeed;
  }
  EXPECT_TRUE(tripped);
  EXPECT_EQ(host_->lifecycle(), Lifecycle::kFault);
  // A host at fault wishes for no force: the trip is over. Force comes back by the user alone.
  device_.v[0] = 0;
  EXPECT_EQ(server_->tripped(), ForceOff::kNone);
  host_->Recover();
  host_->Activate();
  for (int k = 0; k < 40; ++k) {
    HostTick(1);
    DeviceTick();
  }
  EXPECT_EQ(device_.force[0], 1);
}

TEST_F(UdpPair, CommandThatWouldLiveForeverDiesWithTheHost) {
  Connect();
  HostTick(1);
  DeviceTick();
  MasterCommand command;
  command.sequence = ++commands_;
  command.mode = CommandMode::kWrench;
  command.F_Ho_D[0] = 1;  // valid until the end of days
  (void)host_->Write(command);
  for (int k = 0; k < 20; ++k) DeviceTick();
  EXPECT_EQ(device_.force[0], 0);
  EXPECT_EQ(device_.lifecycle(), Lifecycle::kInactive);
}

TEST(UdpMaster, SaysWhomItCouldNotReach) {
  UdpMasterOptions options;
  options.device.port = UdpSocket(UdpAddress{}).port();  // nobody any more
  options.connect_timeout = 0.02;
  UdpMaster master(options);
  EXPECT_THROW(master.Configure(), std::runtime_error);
  options.device.host = "somewhere";
  EXPECT_THROW(UdpMaster{options}, std::invalid_argument);
}

}  // namespace
}  // namespace vmech::udp_test
