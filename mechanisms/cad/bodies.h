#pragma once

#include <string>
#include <vector>

#include "vmech/mechanisms/cad/contacts.h"
#include "vmech/mechanisms/cad/step/cad_assembly.h"

namespace vmech {

/// What moves as one: a link to be.
struct CadBody {
  std::string name;                 ///< of the subassembly or part
  Posed X_WL;                       ///< the axes of the subassembly or part in those of the file
  std::vector<int> parts;           ///< indices in CadAssembly
  std::vector<int> frames;          ///< those that vmech knows (frame_name.h)
  std::vector<int> fasteners = {};  ///< those of `parts` that are screws, rivets, pins
};

/// Which parts of an assembly are one body, as a user says.
struct BodyOptions {
  /// Subassemblies in which nothing moves, and parts that belong to what they touch.
  std::vector<std::string> rigid;
  std::vector<std::string> ignore;  ///< parts and subassemblies to be left out
  /// Bodies or parts that are one body: each list is joined to its first.
  std::vector<std::vector<std::string>> weld = {};
  std::vector<std::string> moving = {};  ///< parts that are no fasteners (fasteners.h)
};

/// The bodies of an assembly:
///   - a subassembly named in `rigid` is one, with all that is below it;
///   - a subassembly with frames directly in it is one, with the parts below it that belong to no
///     other; so that a part and its anchors make up one subassembly;
///   - any other part is one by itself.
/// `loose` receives the frames that stand directly in the file: they belong to the ground.
/// @throws FileErrors if an option names no part or subassembly of the file.
std::vector<CadBody> FindBodies(const CadAssembly& assembly, const BodyOptions& options,
                                std::vector<int>* loose);

/// True for the names by which a body is taken for the ground: ground, frame, base, housing, stand.
bool IsUsualGround(const std::string& name);

/// The features of all parts of a body, in world axes.
WorldFeatures FeaturesOf(const CadAssembly& assembly, const CadBody& body);

}  // namespace vmech
