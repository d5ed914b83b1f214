#pragma once

#include <string>
#include <string_view>

#include "vmech/studies/study.h"

namespace vmech {

/// The scene of a study's motion for the page (SceneJson). `session`: as Scene::session.
std::string MotionScene(const StudyFile& file, const LoadStudyResult& loads,
                        std::string_view version, std::string_view session = "");

}  // namespace vmech
