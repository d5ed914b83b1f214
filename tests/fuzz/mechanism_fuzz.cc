#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vmech/mechanisms/files/reader.h"

namespace {

/// What every reader of a mechanism takes for granted.
bool IsSound(const vmech::Mechanism& mechanism) {
  const int links = static_cast<int>(mechanism.links.size());
  const auto exists = [&](vmech::AnchorId id) {
    return id.link >= 0 && id.link < links && id.anchor >= 0 &&
           id.anchor < static_cast<int>(mechanism.links[id.link].anchors.size());
  };
  bool sound = mechanism.ground >= 0 && mechanism.ground < links && mechanism.gravity_W.allFinite();
  for (const vmech::Link& link : mechanism.links) {
    sound &= link.mass_properties.mass >= 0 && link.mass_properties.I_Lcm.allFinite();
    for (const vmech::Anchor& anchor : link.anchors) {
      sound &= anchor.X_LA.p.allFinite() && std::abs(anchor.X_LA.R.determinant() - 1) < 1e-9;
    }
  }
  for (const vmech::Joint& joint : mechanism.joints) {
    const int coordinates = vmech::CoordinatesOf(joint.type);
    sound &= exists(joint.first) && exists(joint.second) && joint.first.link != joint.second.link;
    sound &= static_cast<int>(joint.start.size()) == coordinates;
    for (const double value : joint.start) sound &= std::isfinite(value);
  }
  return sound;
}

}  // namespace

/// Any bytes either give a sound mechanism or are refused with a list of errors; nothing else.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (!IsSound(vmech::ParseMechanism(text, "fuzz.yaml"))) std::abort();
  } catch (const vmech::FileErrors& errors) {
    if (errors.errors().empty()) std::abort();
  }
  return 0;
}
