#include "vmech/apps/report/motion_scene.h"

#include "vmech/apps/drawing/mechanism_drawing.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/apps/view/meshes.h"
#include "vmech/apps/view/scene.h"
#include "vmech/base/text/base64.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"

namespace vmech {
namespace {

/// Of the assembled mechanism, with the loops cut where the study has cut them.
KinematicTree TreeOf(const LoadStudy& study, const LoadStudyResult& loads) {
  SpanningTreeOptions options;
  for (const std::string& cut : loads.cut_joints) {
    options.cut.push_back(FindJoint(study.mechanism, cut));
  }
  return BuildKinematicTree(AssembleMechanism(study.mechanism).mechanism, options);
}

}  // namespace

std::string MotionScene(const StudyFile& file, const LoadStudyResult& loads,
                        std::string_view version, std::string_view session,
                        std::string_view parameters) {
  const KinematicTree tree = TreeOf(file.study, loads);
  const Cycle cycle = CycleOf(file.study, loads);
  Scene scene;
  scene.title = file.name;
  scene.version = version;
  scene.tree = &tree;
  scene.meshes = ReadMeshes(tree.mechanism, MeshFolderOf(file.mechanism_path));
  scene.study = &file.study;
  // Without poses of the links there is nothing to play.
  scene.loads = loads.poses.arrays().links.empty() ? nullptr : &loads;
  scene.axis = {cycle.axis.title, cycle.axis.unit, cycle.values, {}};
  for (const plot::Station& centre : cycle.dead_centres) {
    scene.axis.dead_centres.push_back({centre.x, centre.label});
  }
  scene.session = session;
  scene.parameters = parameters;
  return SceneJson(scene);
}

html::Markup PrintedMechanism(const LoadStudy& study, const LoadStudyResult& loads) {
  // As an image of its own: the styles of a drawing are not those of the page.
  return html::Markup::Raw(
      "<figure class=\"printed\"><svg width=\"660\" height=\"460\" role=\"img\" "
      "aria-label=\"the mechanism at its start\"><image width=\"660\" height=\"460\" "
      "href=\"data:image/svg+xml;base64," +
      Base64(DrawMechanism(TreeOf(study, loads))) + "\"/></svg></figure>\n");
}

}  // namespace vmech
