#include "vmech/mechanisms/files/inserted.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

constexpr size_t kMaxName = 100;  // bytes, as of every name in a file

/// Where the parts of a mechanism go in another.
class Insertion {
 public:
  Insertion(const Mechanism& part, const std::string& prefix, int on, const Posed& X_LU,
            Mechanism* whole)
      : part_(part), prefix_(prefix + "."), on_(on), X_LU_(X_LU), whole_(whole) {
    anchors_before_ = static_cast<int>(whole->links[on].anchors.size());
    int next = static_cast<int>(whole->links.size());
    for (int i = 0; i < static_cast<int>(part.links.size()); ++i) {
      link_of_.push_back(i == part.ground ? on : next++);
    }
  }

  std::string Defect() const {
    for (const Link& link : part_.links) {
      if (std::string defect = DefectOfName(link.name); !defect.empty()) return defect;
      if (FindLink(*whole_, prefix_ + link.name) >= 0) return Twice("link", link.name);
    }
    for (const Joint& joint : part_.joints) {
      if (std::string defect = DefectOfName(joint.name); !defect.empty()) return defect;
    }
    for (const Anchor& anchor : part_.links[part_.ground].anchors) {
      for (const Anchor& other : whole_->links[on_].anchors) {
        if (other.name == prefix_ + anchor.name) return Twice("anchor", anchor.name);
      }
    }
    return {};
  }

  void AddAll() {
    AddLinks();
    const int joints_before = static_cast<int>(whole_->joints.size());
    for (Joint joint : part_.joints) {
      joint.name = prefix_ + joint.name;
      joint.first = Moved(joint.first);
      joint.second = Moved(joint.second);
      whole_->joints.push_back(std::move(joint));
    }
    for (Grasp grasp : part_.grasps) {
      grasp.name = prefix_ + grasp.name;
      if (grasp.link == part_.ground) grasp.X_LG = X_LU_ * grasp.X_LG;
      grasp.link = link_of_[grasp.link];
      whole_->grasps.push_back(std::move(grasp));
    }
    for (const int cut : part_.preferred_cuts)
      whole_->preferred_cuts.push_back(joints_before + cut);
  }

 private:
  std::string DefectOfName(const std::string& name) const {
    if (prefix_.size() + name.size() <= kMaxName) return {};
    return fmt::format("the name {}{} is longer than {} bytes", prefix_, name, kMaxName);
  }

  std::string Twice(const char* what, const std::string& name) const {
    return fmt::format("there is {} {} '{}{}' already; give one of the two another name",
                       what[0] == 'a' ? "an" : "a", what, prefix_, name);
  }

  void AddLinks() {
    AddMassOfGround();
    for (int i = 0; i < static_cast<int>(part_.links.size()); ++i) {
      const Link& link = part_.links[i];
      if (i == part_.ground) {
        for (const Anchor& anchor : link.anchors) {
          whole_->links[on_].anchors.push_back({prefix_ + anchor.name, X_LU_ * anchor.X_LA});
        }
      } else {
        whole_->links.push_back(link);
        whole_->links.back().name = prefix_ + link.name;
      }
    }
  }

  void AddMassOfGround() {
    const auto numbers = [](const MassProperties& body) {
      return BodyNumbers<double>{body.mass, body.p_LoLcm, body.I_Lcm};
    };
    MassProperties& on = whole_->links[on_].mass_properties;
    const MassProperties& ground = part_.links[part_.ground].mass_properties;
    if (ground.mass == 0) return;
    const BodyNumbers<double> sum =
        Composed<double>({numbers(on), InFrame(X_LU_, numbers(ground))});
    on = {sum.mass, sum.p_cm, sum.I_cm};
  }

  AnchorId Moved(AnchorId id) const {
    const int before = id.link == part_.ground ? anchors_before_ : 0;
    return {link_of_[id.link], id.anchor + before};
  }

  const Mechanism& part_;
  std::string prefix_;
  int on_;
  const Posed& X_LU_;
  Mechanism* whole_;
  int anchors_before_ = 0;
  std::vector<int> link_of_;
};

}  // namespace

std::string Insert(const Mechanism& part, const std::string& prefix, int on, const Posed& X_LU,
                   Mechanism* whole) {
  Insertion insertion(part, prefix, on, X_LU, whole);
  if (std::string defect = insertion.Defect(); !defect.empty()) return defect;
  insertion.AddAll();
  return {};
}

}  // namespace vmech
