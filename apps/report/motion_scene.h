#pragma once

#include <string>
#include <string_view>

#include "vmech/apps/html/markup.h"
#include "vmech/studies/study.h"

namespace vmech {

/// The scene of a study's motion for the page (SceneJson). `session`,
/// `parameters`: as in Scene.
std::string MotionScene(const StudyFile& file, const LoadStudyResult& loads,
                        std::string_view version, std::string_view session = "",
                        std::string_view parameters = "");

/// The mechanism at its start as a picture that is seen on paper alone, where nothing moves.
html::Markup PrintedMechanism(const LoadStudy& study, const LoadStudyResult& loads);

}  // namespace vmech
