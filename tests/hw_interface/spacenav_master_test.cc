#include "vmech/hw_interface/masters/spacenav_master.h"

#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "support/temp_folder.h"

namespace vmech::spacenav_master_test {
namespace {

constexpr std::int64_t kTick = 1'000'000;  // [ns]

/// Speaks as spacenavd does to a client of its first protocol.
class FakeDaemon : public testing::Test {
 protected:
  FakeDaemon() {
    listener_ = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(listener_, 1), 0);
    SpacenavOptions options;
    options.socket = path_;
    master_ = std::make_unique<SpacenavMaster>(options);
    master_->Configure();
    client_ = accept(listener_, nullptr, nullptr);
  }
  ~FakeDaemon() override {
    HangUp();
    close(listener_);
  }
  void HangUp() {
    if (client_ >= 0) close(client_);
    client_ = -1;
  }
  void Say(const std::array<std::int32_t, 8>& event, std::size_t from = 0,
           std::size_t to = sizeof(std::int32_t) * 8) {
    const char* bytes = reinterpret_cast<const char*>(event.data());
    EXPECT_EQ(send(client_, bytes + from, to - from, 0), static_cast<ssize_t>(to - from));
  }
  MasterState Read(int tick, IoStatus expected = IoStatus::kOk) {
    MasterState state;
    EXPECT_EQ(master_->Read(tick * kTick, &state), expected);
    return state;
  }

  TempFolder folder_;
  std::string path_ = folder_ / "spnav.sock";
  int listener_ = -1, client_ = -1;
  std::unique_ptr<SpacenavMaster> master_;
};

TEST_F(FakeDaemon, DeflectionMovesTheHandle) {
  Read(0);
  Say({0, 100, 0, -200, 0, 0, 0, 16});
  Read(1);
  const MasterState state = Read(11);
  EXPECT_NEAR(state.V_DH[0], 0.1, 1e-12);
  EXPECT_NEAR(state.X_DH.p.x(), 11e-3 * 0.1, 1e-12);
  EXPECT_NEAR(state.X_DH.p.z(), -11e-3 * 0.2, 1e-12);
}

TEST_F(FakeDaemon, TwistTurnsTheHandle) {
  Read(0);
  Say({0, 0, 0, 0, 0, 200, 0, 16});
  const MasterState state = Read(100);  // 1 rad/s for 0.1 s about y
  EXPECT_NEAR(state.X_DH.R(0, 2), std::sin(0.1), 1e-12);
}

TEST_F(FakeDaemon, ButtonClosesTheGripper) {
  EXPECT_GT(Read(0).gripper_opening, 0.5);
  Say({1, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(Read(1).gripper_opening, 0);
  Say({2, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_GT(Read(2).gripper_opening, 0.5);
}

TEST_F(FakeDaemon, EventsMayArriveInPieces) {
  Say({0, 100, 0, 0, 0, 0, 0, 16}, 0, 10);
  EXPECT_EQ(Read(0).V_DH[0], 0);
  Say({0, 100, 0, 0, 0, 0, 0, 16}, 10);
  EXPECT_NEAR(Read(1).V_DH[0], 0.1, 1e-12);
}

TEST_F(FakeDaemon, HandleStopsWhenTheDaemonGoes) {
  Read(0);
  Say({0, 100, 0, 0, 0, 0, 0, 16});
  const double x = Read(1).X_DH.p.x();
  HangUp();
  EXPECT_EQ(Read(50, IoStatus::kLinkLost).X_DH.p.x(), x);
}

TEST(SpacenavMaster, SaysWhichDaemonIsMissing) {
  SpacenavOptions options;
  options.socket = TempFolder() / "nobody.sock";
  SpacenavMaster master(options);
  EXPECT_THROW(master.Configure(), std::runtime_error);
}

}  // namespace
}  // namespace vmech::spacenav_master_test
