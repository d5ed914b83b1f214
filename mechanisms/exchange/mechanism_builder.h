#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/exchange/imported.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {

/// Where something stands.
struct Place {
  std::string file;  ///< its name, for messages
  int line = 0;      ///< from 1; 0: not known
};

/// Puts a mechanism together from links that are drawn in their places, as other programs have
/// them: joints are given once in the world, and become an anchor on either link.
class MechanismBuilder {
 public:
  MechanismBuilder(std::string name, ImportOptions options);  ///< `name` of the mechanism

  /// Index of the new link. The name is made fit for the format (Node::CheckName) and unique; a
  /// note says so. Its inertia may be what no body has: Finish mends it.
  int AddLink(std::string_view name, const MassProperties& properties, const Posed& X_WL,
              const Place& place = {});
  /// A joint at its zero position, the frame in the world: z the axis (kUniversal: x and y).
  Joint& AddJoint(std::string_view name, JointType type, int first, int second, const Posed& X_WJ);
  /// The same with the frame given on either link, so that these need not be in their places.
  Joint& AddJoint(std::string_view name, JointType type, int first, const Posed& X_LF, int second,
                  const Posed& X_LM);
  void AddGrasp(std::string_view name, int link, const Posed& X_LG);  ///< in the axes of the link
  /// A sentence for the user.
  void Note(std::string note) { imported_.notes.push_back(std::move(note)); }
  /// Says what was wrong and what was done about it; with ImportOptions::strict Finish refuses it.
  void NoteMended(const Place& place, const std::string& defect, const std::string& change);
  /// Limits of a freedom, infinite where there is none. The start becomes the place between them
  /// that is nearest to zero, with a note if it is another. Limits that would hold the joint are
  /// left out, as mended: programs write them that know none. @throws FileErrors if lower > upper
  void SetLimits(const Place& place, double lower, double upper, size_t freedom, Joint* joint);

  /// Decides what stands still, turns gravity into its axes, mends inertias, and checks the whole
  /// as a file of mechanisms is checked. Gravity and `fixed_to_world` are taken if the options name
  /// none. @throws FileErrors as ParseMechanism, for a ground that there is not, and for what was
  ///         mended if the options are strict; `file` names it.
  ImportedMechanism Finish(std::optional<int> fixed_to_world, const Vector3d& gravity_W,
                           const std::string& file);

 private:
  std::string FitName(std::string_view name, std::set<std::string>* taken);
  int ChooseGround(std::optional<int> fixed, const std::string& file);
  void MendInertias();
  void RequireReadable(const std::string& file) const;
  Place PlaceOf(const std::string& path) const;

  const ImportOptions options_;
  ImportedMechanism imported_;
  std::vector<Posed> poses_;
  std::vector<Place> places_;        ///< of the links
  std::vector<FileError> refusals_;  ///< what was mended, if that is not wanted
  std::set<std::string> links_, joints_, grasps_;
};

/// A frame with the given z axis, and x as near as can be to the x axis of `near`, or to its y
/// axis.
Matrix3d AxesAlong(const Vector3d& z, const Matrix3d& near);

}  // namespace vmech
