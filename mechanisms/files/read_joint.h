#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The anchors of the links of a file by the name that joints use, "link/anchor".
class AnchorNames {
 public:
  explicit AnchorNames(const std::vector<Link>& links);  ///< keeps a reference
  /// The anchor that a node names; reports it, with a near miss, if there is none.
  AnchorId Find(const Node& node) const;
  /// The anchor of a joint's name on the link that a node names; reports a link that there is not.
  AnchorId FindOnLink(const Node& node, const std::string& joint) const;

 private:
  std::unordered_map<std::string, AnchorId> ids_;
  std::vector<std::string> names_, links_;
};

/// An entry of `joints`. Reports what is wrong at its node.
Joint ReadJoint(const Node& node, const AnchorNames& anchors, const Units& units);

}  // namespace vmech
