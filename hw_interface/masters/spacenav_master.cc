#include "vmech/hw_interface/masters/spacenav_master.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "vmech/base/check_range.h"

namespace vmech {
namespace {

constexpr const char* kUsualSocket = "/var/run/spnav.sock";
enum Event : std::int32_t { kMotion = 0, kPress = 1, kRelease = 2 };

std::string SocketPath(const std::string& wanted) {
  if (!wanted.empty()) return wanted;
  const char* environment = std::getenv("SPNAV_SOCKET");
  return environment ? environment : kUsualSocket;
}

int Connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    throw std::invalid_argument(fmt::format("spacenav: socket path '{}' is too long", path));
  }
  path.copy(address.sun_path, path.size());
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  const std::string reason = std::strerror(errno);
  ::close(fd);
  throw std::runtime_error(
      fmt::format("spacenav: no daemon at {}: {}; start spacenavd, or name its socket in "
                  "SPNAV_SOCKET",
                  path, reason));
}

}  // namespace

void SpacenavOptions::Validate() const {
  CheckRange("SpacenavOptions", "period", period, 1e-4, 0.1);
  CheckRange("SpacenavOptions", "speed", speed, 1e-9, 1);
  CheckRange("SpacenavOptions", "angular_speed", angular_speed, 1e-9, 10);
}

SpacenavMaster::SpacenavMaster(SpacenavOptions options)
    : options_(std::move(options)), X_DH_(options_.X_DH) {
  options_.Validate();
}

DeviceInfo SpacenavMaster::OnConfigure() {
  fd_ = Connect(SocketPath(options_.socket));
  DeviceInfo info;
  info.name = "spacenav";
  info.period = options_.period;
  info.senses = kSensesPose | kSensesTwist | kSensesGripper | kSensesButtons;
  return info;
}

void SpacenavMaster::OnShutdown() noexcept {
  ::close(fd_);
}

/// Reads all events that wait; false if the daemon has gone.
bool SpacenavMaster::TakeEvents() noexcept {
  while (true) {
    auto* bytes = reinterpret_cast<char*>(event_.data());
    const ssize_t n = ::recv(fd_, bytes + received_, sizeof event_ - received_, MSG_DONTWAIT);
    if (n < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (n == 0) return false;
    received_ += static_cast<std::size_t>(n);
    if (received_ < sizeof event_) continue;
    received_ = 0;
    if (event_[0] == kMotion) {
      for (int i = 0; i < 6; ++i) {
        V_DH_[i] = event_[1 + i] * (i < 3 ? options_.speed : options_.angular_speed);
      }
    } else if (event_[1] >= 0 && event_[1] < 32) {
      const std::uint32_t button = 1u << event_[1];
      buttons_ = event_[0] == kPress ? buttons_ | button : buttons_ & ~button;
    }
  }
}

void SpacenavMaster::Move(double seconds) noexcept {
  X_DH_.p += seconds * V_DH_.head<3>();
  const Vector3d turn = seconds * V_DH_.tail<3>();
  const double angle = turn.norm();
  if (angle == 0) return;
  const Eigen::Quaterniond step(Eigen::AngleAxisd(angle, turn / angle));
  X_DH_.R = (step * Eigen::Quaterniond(X_DH_.R)).normalized().toRotationMatrix();
}

IoStatus SpacenavMaster::OnRead(std::int64_t now_ns, MasterState* state) noexcept {
  constexpr double kLongestStep = 0.1;  // [s]: after a pause the handle does not leap
  constexpr double kOpen = 0.8;         // [rad]
  const bool there = TakeEvents();
  if (!there) V_DH_.setZero();
  const double elapsed = sequence_ > 0 ? static_cast<double>(now_ns - last_ns_) * 1e-9 : 0;
  Move(std::clamp(elapsed, 0.0, kLongestStep));
  last_ns_ = now_ns;
  *state = MasterState{};
  state->sequence = ++sequence_;
  state->device_time_ns = now_ns;
  state->valid = info().senses;
  state->buttons = buttons_;
  state->dead_man = true;
  state->X_DH = X_DH_;
  state->V_DH = V_DH_;
  state->gripper_opening = buttons_ & 1u ? 0 : kOpen;
  return there ? IoStatus::kOk : IoStatus::kLinkLost;
}

}  // namespace vmech
