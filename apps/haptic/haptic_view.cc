#include "vmech/apps/haptic/haptic_view.h"

#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "vmech/apps/view/json_text.h"
#include "vmech/apps/view/page_session.h"
#include "vmech/apps/view/scene.h"
#include "vmech/apps/view/view_page.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/link_poses.h"

namespace vmech {
namespace {

using Json = nlohmann::json;

Json ArrayOf(const Vector6d& w) {
  return {w[0], w[1], w[2], w[3], w[4], w[5]};
}

Json Figure(const char* name, double value, const char* unit) {
  return {{"name", name}, {"value", value}, {"unit", unit}};
}

/// The loop, for a page that watches.
class Subject : public PageSubject {
 public:
  Subject(const KinematicTree& tree, ShownTick* tick, const Runner& runner)
      : tree_(tree), period_(runner.period()), tick_(tick), runner_(runner) {}

  std::string Page() override { return MechanismPage(tree_, {}, VMECH_VERSION, "haptic"); }

  std::string Do(const Json& /*request*/) override {
    throw std::invalid_argument("the device has the mechanism in hand; this page watches");
  }

  std::string NewState() override {
    const std::scoped_lock lock(mutex_);
    if (!tick_->pictures().Take()) return "";
    state_ = JsonText(Json{{"state", StateOf(tick_->pictures().front())}});
    return state_;
  }

  std::string State() override {
    const std::scoped_lock lock(mutex_);
    return state_;
  }

 private:
  Json StateOf(const TickPicture& picture) const {
    const LiveStatus& live = runner_.live();
    Mechanism now = tree_.mechanism;
    SetStarts(tree_, picture.q, &now);
    Json poses = Json::array(), wrenches = Json::array();
    for (const Posed& X_WL : LinkPoses(tree_, picture.q)) poses.push_back(SevenOf(X_WL));
    for (const Wrenchd& w : picture.joints) {
      wrenches.push_back(ArrayOf(Stacked<double>(w.force, w.moment)));
    }
    return {{"time", static_cast<double>(live.ticks) * period_},
            {"mode", "haptic"},
            {"poses", std::move(poses)},
            {"coordinates", StartOfFreedoms(now)},
            {"wrenches", std::move(wrenches)},
            {"haptic",
             {{"hand", SevenOf(picture.X_WH)},
              {"grasp", SevenOf(picture.X_WG)},
              {"constraint", ArrayOf(picture.constraint)},
              {"dynamic", ArrayOf(picture.dynamic)},
              {"figures",
               {Figure("force on the hand", picture.F_Ho_W.head<3>().norm(), "N"),
                Figure("passivity, least energy", live.energy, "J"),
                Figure("a tick computes", 1e-3 * static_cast<double>(live.compute_ns), "us"),
                Figure("slots skipped", static_cast<double>(live.skipped), "")}}}}};
  }

  const KinematicTree& tree_;
  const double period_;
  ShownTick* tick_;
  const Runner& runner_;
  std::mutex mutex_;
  std::string state_;
};

}  // namespace

struct HapticView::Parts {
  Parts(const KinematicTree& tree, ShownTick* tick, const Runner& runner)
      : subject(tree, tick, runner), session(&subject, 0), publisher([this] {
          while (!over) {
            session.Publish();
            std::this_thread::sleep_for(std::chrono::milliseconds(8));
          }
        }) {}
  ~Parts() {
    over = true;
    publisher.join();
  }

  Subject subject;
  PageSession session;
  std::atomic<bool> over = false;
  std::thread publisher;
};

HapticView::HapticView(const KinematicTree& tree, ShownTick* tick, const Runner& runner)
    : parts_(std::make_unique<Parts>(tree, tick, runner)) {}

HapticView::~HapticView() = default;

std::string HapticView::url() const {
  return parts_->session.url();
}

TickPicture PictureOf(const KinematicTree& tree, const VectorXd& q, std::size_t hands) {
  TickPicture picture;
  picture.q = q;
  picture.joints.resize(tree.mechanism.joints.size());
  picture.others.resize(hands - 1);
  return picture;
}

}  // namespace vmech
