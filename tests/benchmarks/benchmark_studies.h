#pragma once

#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Two turns of the slider-crank of the examples at 1500 rpm, every joint wrench.
LoadStudy SliderCrankStudy(int poses);

/// The four-bar linkage with N windows: N + 1 posts on the ground, 1 m apart, and N beams on their
/// tops, all bars of 1 m and 1 kg; mobility 1, N loops (benchmark A02 of the IFToMM library of
/// multibody problems, lim.ii.udc.es/mbsbenchmark). It swings from upright to 0.8 rad at 1 rad/s.
LoadStudy WindowStudy(int windows, int poses);

/// The loads alone, without the motion of every link.
inline LoadStudyOptions JointLoadsOnly() {
  LoadStudyOptions options;
  options.link_motions = false;
  return options;
}

}  // namespace vmech
