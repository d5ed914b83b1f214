#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/mechanisms/cad/bodies.h"
#include "vmech/mechanisms/cad/step/frame_name.h"

namespace vmech {

/// A named frame on a body.
struct BodyFrame {
  int body = -1;      ///< index of the body; -1: directly in the file
  std::string frame;  ///< as the file calls it
  FrameName name;     ///< its name, taken apart
  Posed X_WA;         ///< pose in the axes of the file; turned already if its name ends in _inv
};

/// Two frames of one joint on two bodies.
struct AnchorPair {
  BodyFrame first, second;  ///< in the order of the file
};

/// Pairs by name. FreeCAD numbers names that come twice ("anchor_pin001"): such a number is
/// overlooked where the name without it is there, too.
struct AnchorMatches {
  std::vector<AnchorPair> pairs;     ///< in the order of their first frames
  std::vector<BodyFrame> unmatched;  ///< whose joint has no other frame
  std::vector<std::string> errors;   ///< three anchors of one joint, both on one body
};
/// Pairs the frames that name the same joint.
AnchorMatches MatchAnchors(std::vector<BodyFrame> frames);

/// The nearest frame on another body, free ones before others; none if there is no other.
std::optional<BodyFrame> NearestFrame(const BodyFrame& frame, const std::vector<BodyFrame>& free,
                                      const std::vector<BodyFrame>& all);

}  // namespace vmech
