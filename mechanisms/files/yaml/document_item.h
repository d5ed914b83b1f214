#pragma once

#include <string>
#include <vector>

namespace vmech {

constexpr int kMaxNesting = 64;  ///< levels of lists and maps in a file

/// What a node of a document is.
enum class NodeKind { kAbsent, kNull, kScalar, kList, kMap };

/// A node as it is stored; the children of a list or map are indices.
struct DocumentItem {
  NodeKind kind = NodeKind::kNull;  ///< of what stands there
  bool plain = true;                ///< a scalar without quotes: a number if it looks like one
  std::string text, key;            ///< of a scalar; of an entry of a map
  int line = 0, column = 0, key_line = 0, key_column = 0;  ///< from 1
  int parent = -1, place = 0;  ///< `place` is the position in the parent
  std::vector<int> children;   ///< indices of items
};

}  // namespace vmech
