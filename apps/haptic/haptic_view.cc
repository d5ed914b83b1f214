#include "vmech/apps/haptic/haptic_view.h"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
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

}  // namespace

/// The loop, for a page that watches.
class HapticView::Subject : public PageSubject {
 public:
  Subject(const KinematicTree& tree, Runner* runner, LiveVariation variation)
      : tree_(tree), runner_(runner), variation_(std::move(variation)) {
    if (design() != nullptr) values_ = design()->asked();
  }

  std::string Page() override {
    const std::scoped_lock lock(mutex_);
    const std::string sliders = design() != nullptr ? JsonText(design()->Sliders()) : "";
    return MechanismPage(tree_, {}, VMECH_VERSION, "haptic", sliders);
  }

  std::string Do(const Json& request) override {
    const std::scoped_lock lock(mutex_);
    const std::string what = request["do"];
    if (design() != nullptr && what == "vary") {
      design()->Ask(request);
      return "";
    }
    if (design() != nullptr && what == "save" && request.value("what", Json()) == "parameters") {
      return design()->Saved(values_);
    }
    throw std::invalid_argument("the device has the mechanism in hand; this page watches");
  }

  std::string NewState() override {
    const std::scoped_lock lock(mutex_);
    if (!runner_->pictures().Take()) return "";
    const TickPicture& picture = runner_->pictures().front();
    LeadDesign(picture);
    Json message{{"state", StateOf(picture)}};
    if (design() != nullptr) {
      message["state"]["design"] = design()->StateOf(values_, picture.design_work);
    }
    state_ = JsonText(message);
    if (design() != nullptr) state_ = design()->Told(state_);
    return state_;
  }

  std::string State() override {
    const std::scoped_lock lock(mutex_);
    return state_;
  }

 private:
  LiveDesign* design() { return variation_.design.get(); }

  /// Sends the tick the next design, and takes the shape of the one that it has.
  void LeadDesign(const TickPicture& picture) {
    if (design() == nullptr) return;
    const bool heard = picture.design_number == sent_;
    const std::optional<HeldDesign> next =
        design()->Next({picture.q, picture.design, heard && picture.design_arrived,
                        heard && picture.design_stopped});
    if (next) {
      variation_.tick->designs().back() = {++sent_, *next};
      variation_.tick->designs().Publish();
    }
    if (picture.design == values_) return;
    values_ = picture.design;
    tree_ = design()->ReadAt(values_, tree_, picture.q);
    design()->Reshape(tree_);
  }

  Json StateOf(const TickPicture& picture) const {
    const LiveStatus& live = runner_->live();
    Mechanism now = tree_.mechanism;
    SetStarts(tree_, picture.q, &now);
    Json poses = Json::array(), wrenches = Json::array();
    for (const Posed& X_WL : LinkPoses(tree_, picture.q)) poses.push_back(SevenOf(X_WL));
    for (const Wrenchd& w : picture.joints) {
      wrenches.push_back(ArrayOf(Stacked<double>(w.force, w.moment)));
    }
    return {{"time", static_cast<double>(live.ticks) * runner_->period()},
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

  KinematicTree tree_;  // as it is now
  Runner* runner_;
  LiveVariation variation_;
  VectorXd values_;         // of the design that pages have
  std::uint64_t sent_ = 0;  // designs
  std::mutex mutex_;
  std::string state_;
};

struct HapticView::Parts {
  Parts(const KinematicTree& tree, Runner* runner, LiveVariation variation)
      : subject(tree, runner, std::move(variation)), session(&subject, 0), publisher([this] {
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

HapticView::HapticView(const KinematicTree& tree, Runner* runner, LiveVariation variation)
    : parts_(std::make_unique<Parts>(tree, runner, std::move(variation))) {}

HapticView::~HapticView() = default;

std::string HapticView::url() const {
  return parts_->session.url();
}

}  // namespace vmech
