#include "vmech/mechanisms/cad/fasteners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr double kSlim = 2;         // k^2 / r^2 of a screw, k its radius of gyration, at most
constexpr double kOffCentre = 0.1;  // of the centre of gravity from the axis, of the radius
constexpr double kNutHeight = 1.2, kNutWidth = 2.65;    // of the bore's diameter; k^2 / r^2
constexpr double kDiscHeight = 0.35, kDiscWidth = 5.2;  // the same of washers
constexpr double kMicron = 1e-6;      // [m]: fits that differ by less are equally tight
constexpr double kMillimetres = 1e3;  // per metre

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// A neighbour, and what touches there; the candidate is the first body of the contacts.
struct Touch {
  int body;
  std::vector<SurfaceContact> contacts;
};

bool IsShaft(const SurfaceContact& contact) {
  return contact.surface == CadSurface::kShaft && contact.first_inside;
}

bool IsBore(const SurfaceContact& contact) {
  return contact.surface == CadSurface::kShaft && !contact.first_inside;
}

bool IsPlane(const SurfaceContact& contact) {
  return contact.surface == CadSurface::kPlane;
}

template <typename Predicate>
bool Any(const std::vector<Touch>& touches, Predicate is) {
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
    return std::any_of(touch.contacts.begin(), touch.contacts.end(), is);
  });
}

/// The thickest of the contacts that are asked for.
template <typename Predicate>
std::optional<SurfaceContact> Thickest(const std::vector<Touch>& touches, Predicate is) {
  std::optional<SurfaceContact> thickest;
  for (const Touch& touch : touches) {
    for (const SurfaceContact& contact : touch.contacts) {
      if (is(contact) && (!thickest || contact.radius > thickest->radius)) thickest = contact;
    }
  }
  return thickest;
}

/// True if all that touches does so about one axis.
bool IsAboutOneAxis(const std::vector<Touch>& touches, const SurfaceContact& fit,
                    double tolerance) {
  return !Any(touches, [&](const SurfaceContact& contact) {
    if (contact.surface == CadSurface::kBall) return true;
    if (contact.axis_W.cross(fit.axis_W).norm() > kParallelAxes) return true;
    const double aside = (contact.p_W - fit.p_W).cross(fit.axis_W).norm();
    return !IsPlane(contact) && aside > tolerance + kDrawn;
  });
}

/// How tightly a body holds a part: less is tighter. Fits come before planes, and of two equal fits
/// the longer; of planes the more.
std::tuple<int, double, double> Looseness(const std::vector<SurfaceContact>& contacts) {
  std::tuple<int, double, double> best{2, 0, 0};
  double planes = 0;
  for (const SurfaceContact& contact : contacts) {
    if (IsPlane(contact)) {
      best = std::min(best, {1, -(planes += 1), 0});
    } else {
      best = std::min(best, {0, std::round(contact.gap / kMicron), -contact.length});
    }
  }
  return best;
}

std::string Describe(const std::vector<SurfaceContact>& contacts) {
  const SurfaceContact* tightest = nullptr;
  for (const SurfaceContact& contact : contacts) {
    if (IsPlane(contact) || (tightest != nullptr && tightest->gap <= contact.gap)) continue;
    tightest = &contact;
  }
  if (tightest == nullptr) return "plane on plane";
  const bool is_ball = tightest->surface == CadSurface::kBall;
  return fmt::format("{} of {:.6g} mm in a {} of {:.6g} mm", is_ball ? "ball" : "shaft",
                     2 * kMillimetres * tightest->radius, is_ball ? "socket" : "bore",
                     2 * kMillimetres * (tightest->radius + tightest->gap));
}

class Merger {
 public:
  Merger(const CadAssembly& assembly, const BodyOptions& options, const ContactOptions& contacts,
         const std::string& ground, std::vector<CadBody>* bodies)
      : assembly_(assembly),
        options_(options),
        contacts_(contacts),
        ground_(ground),
        bodies_(*bodies),
        into_(bodies->size()),
        is_fastener_(bodies->size(), false) {
    std::iota(into_.begin(), into_.end(), 0);
    for (const CadBody& body : bodies_) features_.push_back(FeaturesOf(assembly, body));
  }

  std::vector<BodyMerge> Run() {
    for (const std::vector<std::string>& names : options_.weld) Weld(names);
    for (const std::string& name : options_.rigid) MakeRigid(name);
    if (!errors_.empty()) throw FileErrors(errors_);
    Fasten();
    Apply();
    return std::move(merges_);
  }

 private:
  void Error(std::string message) {
    errors_.push_back({assembly_.file, 0, 0, "", std::move(message)});
  }

  int RootOf(int body) const {
    while (into_[body] != body) body = into_[body];
    return body;
  }

  void Join(int body, int into, std::string why, bool is_guess) {
    body = RootOf(body);
    into = RootOf(into);
    if (body == into) return;
    into_[body] = into;
    merges_.push_back({bodies_[body].name, bodies_[into].name, std::move(why), is_guess});
  }

  /// The body of a name, or that of the part of that name; -1 if there is none.
  int FindBody(const std::string& name) const {
    const auto find = [&](auto matches) {
      const auto it = std::find_if(bodies_.begin(), bodies_.end(), matches);
      return it == bodies_.end() ? -1 : static_cast<int>(it - bodies_.begin());
    };
    const int body = find([&](const CadBody& candidate) { return candidate.name == name; });
    if (body >= 0) return body;
    return find([&](const CadBody& candidate) {
      return std::any_of(candidate.parts.begin(), candidate.parts.end(),
                         [&](int part) { return assembly_.parts[part].name == name; });
    });
  }

  bool IsGround(int body) const {
    const std::string& name = bodies_[body].name;
    return ground_.empty() ? IsUsualGround(name) : name == ground_;
  }

  void Weld(const std::vector<std::string>& names) {
    std::vector<int> welded;
    for (const std::string& name : names) {
      const int body = FindBody(name);
      if (body < 0) {
        Error(
            fmt::format("{} (--weld) is no body: it is left out, or a subassembly of several; "
                        "name its parts, or make it one (--rigid)",
                        Quoted(name)));
        return;
      }
      welded.push_back(body);
    }
    const auto ground = std::find_if(welded.begin(), welded.end(),
                                     [&](int body) { return IsGround(RootOf(body)); });
    const int into = ground == welded.end() ? welded.front() : *ground;
    for (const int body : welded) Join(body, into, "asked for (--weld)", false);
  }

  /// What a body touches, its fits taken for those of a fastener.
  std::vector<Touch> TouchesOf(int body) const {
    WorldFeatures own = features_[body];
    for (CadFeature& feature : own) feature.fastens = true;
    std::vector<Touch> touches;
    for (int other = 0; other < static_cast<int>(bodies_.size()); ++other) {
      if (RootOf(other) == RootOf(body)) continue;
      std::vector<SurfaceContact> contacts = FindContacts(own, features_[other], contacts_);
      if (!contacts.empty()) touches.push_back({other, std::move(contacts)});
    }
    return touches;
  }

  const Touch* Tightest(const std::vector<Touch>& touches) const {
    const auto looseness = [&](const Touch& touch) {
      return std::pair{is_fastener_[touch.body], Looseness(touch.contacts)};
    };
    const auto it = std::min_element(
        touches.begin(), touches.end(),
        [&](const Touch& a, const Touch& b) { return looseness(a) < looseness(b); });
    return it == touches.end() ? nullptr : &*it;
  }

  /// A part by itself; subassemblies of the name are one already (FindBodies).
  void MakeRigid(const std::string& name) {
    const int body = FindBody(name);
    if (body < 0 || !IsSinglePart(body) || bodies_[body].name != name || IsSubassembly(name))
      return;
    const std::vector<Touch> touches = TouchesOf(body);
    const Touch* tightest = Tightest(touches);
    if (tightest == nullptr) {
      return Error(
          fmt::format("part {} (--rigid) touches no other; say to which it belongs (--weld "
                      "BODY,{})",
                      Quoted(name), name));
    }
    is_fastener_[body] = true;
    Join(body, tightest->body, "asked for (--rigid): " + Describe(tightest->contacts), false);
  }

  bool IsSubassembly(const std::string& name) const {
    return std::any_of(assembly_.groups.begin(), assembly_.groups.end(),
                       [&](const CadGroup& group) { return group.name == name; });
  }

  bool IsSinglePart(int body) const {
    return bodies_[body].parts.size() == 1 && bodies_[body].frames.empty();
  }

  bool MayFasten(int body) const {
    return IsSinglePart(body) && into_[body] == body && !IsGround(body) &&
           std::count(into_.begin(), into_.end(), body) == 1 &&
           !Contains(options_.moving, bodies_[body].name) && ShapeOf(body).defect.empty();
  }

  const CadShape& ShapeOf(int body) const {
    return assembly_.shapes[assembly_.parts[bodies_[body].parts[0]].shape];
  }

  double VolumeOf(int body) const {
    double volume = 0;
    for (const int part : bodies_[body].parts) {
      volume += assembly_.shapes[assembly_.parts[part].shape].volume.volume;
    }
    return volume;
  }

  /// k^2 about an axis, if the centre of gravity is on it; else infinity.
  double SquaredGyration(int body, const SurfaceContact& fit) const {
    const CadVolume& volume = ShapeOf(body).volume;
    const Posed& X_WP = assembly_.parts[bodies_[body].parts[0]].X_WP;
    const Vector3d axis_P = X_WP.R.transpose() * fit.axis_W;
    const double aside = (X_WP * volume.p_PoPcm - fit.p_W).cross(fit.axis_W).norm();
    if (aside > kOffCentre * fit.radius) return INFINITY;
    return axis_P.dot(volume.moments * axis_P) / volume.volume;
  }

  bool IsScrew(int body, const std::vector<Touch>& touches) const {
    const auto fit = Thickest(touches, IsShaft);
    if (!fit || !IsAboutOneAxis(touches, *fit, contacts_.tolerance)) return false;
    const auto joined = std::count_if(touches.begin(), touches.end(), [](const Touch& touch) {
      return std::any_of(touch.contacts.begin(), touch.contacts.end(), IsShaft);
    });
    if (joined < 2 && !Any(touches, IsPlane)) return false;
    if (SquaredGyration(body, *fit) > kSlim * fit->radius * fit->radius) return false;
    double largest = 0;
    for (const Touch& touch : touches) largest = std::max(largest, VolumeOf(touch.body));
    return VolumeOf(body) <= largest;
  }

  /// A nut or a washer, given the screws.
  bool IsRing(int body, const std::vector<Touch>& touches) const {
    const auto fit = Thickest(touches, IsBore);
    if (!fit || Any(touches, IsShaft) || !Any(touches, IsPlane)) return false;
    if (!IsAboutOneAxis(touches, *fit, contacts_.tolerance)) return false;
    for (const Touch& touch : touches) {
      const bool is_around = std::any_of(touch.contacts.begin(), touch.contacts.end(), IsBore);
      if (is_around && !is_fastener_[touch.body]) return false;
    }
    const double radius = fit->radius + fit->gap;
    const double width = SquaredGyration(body, *fit) / (radius * radius);
    const double height = fit->length / (2 * radius);
    return (height <= kNutHeight && width <= kNutWidth) ||
           (height <= kDiscHeight && width <= kDiscWidth);
  }

  /// Screws first, then what sits on them.
  void Fasten() {
    const int count = static_cast<int>(bodies_.size());
    std::vector<std::vector<Touch>> touches(count);
    std::vector<int> found;
    for (int body = 0; body < count; ++body) {
      if (MayFasten(body)) touches[body] = TouchesOf(body);
      if (IsScrew(body, touches[body])) found.push_back(body);
    }
    for (const int body : found) is_fastener_[body] = true;
    for (int body = 0; body < count; ++body) {
      if (!is_fastener_[body] && IsRing(body, touches[body])) found.push_back(body);
    }
    for (const int body : found) is_fastener_[body] = true;
    if (!LeavesSomethingToMove(found)) return UndoFasteners(found);
    for (const int body : found) {
      const Touch* tightest = Tightest(touches[body]);
      Join(body, tightest->body, "fastener: " + Describe(tightest->contacts), true);
    }
  }

  bool LeavesSomethingToMove(const std::vector<int>& found) const {
    int left = 0;
    for (int body = 0; body < static_cast<int>(bodies_.size()); ++body) left += into_[body] == body;
    return left - static_cast<int>(found.size()) > 1;
  }

  void UndoFasteners(const std::vector<int>& found) {
    for (const int body : found) is_fastener_[body] = false;
  }

  /// Moves parts and frames to the bodies that stay.
  void Apply() {
    std::vector<CadBody> left;
    std::vector<int> place(bodies_.size(), -1);
    for (size_t body = 0; body < bodies_.size(); ++body) {
      if (into_[body] != static_cast<int>(body)) continue;
      place[body] = static_cast<int>(left.size());
      left.push_back(bodies_[body]);
    }
    for (size_t body = 0; body < bodies_.size(); ++body) {
      const CadBody& moved = bodies_[body];
      CadBody& stays = left[place[RootOf(static_cast<int>(body))]];
      if (into_[body] != static_cast<int>(body)) {
        stays.parts.insert(stays.parts.end(), moved.parts.begin(), moved.parts.end());
        stays.frames.insert(stays.frames.end(), moved.frames.begin(), moved.frames.end());
      }
      if (!is_fastener_[body]) continue;
      stays.fasteners.insert(stays.fasteners.end(), moved.parts.begin(), moved.parts.end());
    }
    bodies_ = std::move(left);
  }

  const CadAssembly& assembly_;
  const BodyOptions& options_;
  const ContactOptions& contacts_;
  const std::string& ground_;
  std::vector<CadBody>& bodies_;
  std::vector<int> into_;  ///< itself, or the body that it belongs to
  std::vector<bool> is_fastener_;
  std::vector<WorldFeatures> features_;
  std::vector<BodyMerge> merges_;
  std::vector<FileError> errors_;
};

}  // namespace

std::vector<BodyMerge> MergeBodies(const CadAssembly& assembly, const BodyOptions& options,
                                   const ContactOptions& contacts, const std::string& ground,
                                   std::vector<CadBody>* bodies) {
  return Merger(assembly, options, contacts, ground, bodies).Run();
}

}  // namespace vmech
