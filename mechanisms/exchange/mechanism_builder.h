#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/exchange/imported.h"

namespace vmech {

/// Puts a mechanism together from links that are drawn in their places, as other programs have
/// them: joints are given once in the world, and become an anchor on either link.
class MechanismBuilder {
 public:
  explicit MechanismBuilder(std::string name);

  /// Index of the new link. The name is made fit for the format (Node::CheckName) and unique; a
  /// note says so.
  int AddLink(std::string_view name, const MassProperties& properties, const Posed& X_WL);
  /// A joint at its zero position, the frame in the world: z the axis (kUniversal: x and y).
  Joint& AddJoint(std::string_view name, JointType type, int first, int second, const Posed& X_WJ);
  /// The same with the frame given on either link, so that these need not be in their places.
  Joint& AddJoint(std::string_view name, JointType type, int first, const Posed& X_LF, int second,
                  const Posed& X_LM);
  void AddGrasp(std::string_view name, int link, const Posed& X_LG);
  void Note(std::string note) { imported_.notes.push_back(std::move(note)); }

  /// Decides what stands still, turns gravity into its axes, and checks the whole as a file of
  /// mechanisms is checked. `guess` is the link that is taken if the options name none.
  /// @throws FileErrors as ParseMechanism, and for a ground that there is not; `file` names it.
  ImportedMechanism Finish(const ImportOptions& options, std::optional<int> fixed_to_world,
                           const Vector3d& gravity_W, const std::string& file);

 private:
  std::string FitName(std::string_view name, std::set<std::string>* taken);
  int ChooseGround(const ImportOptions& options, std::optional<int> fixed, const std::string& file);

  ImportedMechanism imported_;
  std::vector<Posed> poses_;
  std::set<std::string> links_, joints_, grasps_;
};

/// A frame with the given z axis, and x as near as can be to the x axis of `near`, or to its y
/// axis.
Matrix3d AxesAlong(const Vector3d& z, const Matrix3d& near);

}  // namespace vmech
