#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmech/dynamics/bearings/bearing.h"
#include "vmech/dynamics/bearings/joint_bearings.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/simulation/motion_loads.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/dynamics/simulation/simulation_result.h"
#include "vmech/mechanisms/files/mechanism_source.h"

namespace vmech {

/// The bearings that a study asks for at one joint.
struct BearingRequest {
  int joint = -1;                    ///< index in Mechanism::joints
  Arrangement arrangement;           ///< one bearing or two, and where
  BearingRequirements requirements;  ///< life, reliability, lubrication
};

/// Where the origin of a grasp is wanted as the mechanism moves.
struct WantedPath {
  int grasp = -1;                     ///< index in Mechanism::grasps
  std::vector<Vector3d> points = {};  ///< [poses] in the world [m]
};

/// What a study simulates instead of following a motion. The mechanism, drives, external loads,
/// times and the rule are those of StudyFile::study.
struct SimulationRequest {
  Simulation simulation;      ///< with its motors, limits and times
  SimulationOptions options;  ///< how exactly
};

/// A file that a study was read from.
struct InputFile {
  std::filesystem::path path;  ///< absolute
  std::string sha256;          ///< of its bytes, as Sha256
};

/// A study file as read: what to compute, and what is asked of the result.
struct StudyFile {
  std::filesystem::path path;            ///< absolute
  std::string name;                      ///< of the study; the file's stem if it gives none
  std::string description;               ///< free text, may be empty
  std::filesystem::path mechanism_path;  ///< of the file that it names; empty if it is within
  std::string motion;                    ///< the motion in words: "main at 1500 rpm, 2 turns"
  LoadStudy study;                       ///< in SI units
  std::optional<SimulationRequest> simulation;  ///< instead of a motion
  /// A motion that was computed before, instead of its own. What acts is what the study says.
  std::optional<JointHistory> history;
  std::vector<BearingRequest> bearings;          ///< as in the file
  std::vector<WantedPath> paths = {};            ///< as in the file
  std::vector<Bearing> catalogue;                ///< the built-in one unless the file names another
  std::vector<StatedParameter> parameters = {};  ///< of the mechanism and the study
  std::vector<ParameterSetting> settings = {};   ///< with which it was read
  std::vector<std::string> notes = {};  ///< what the file says in a manner that is no longer used
  /// The study itself, its mechanism, its tables and its catalogue, each once, as they were read.
  std::vector<InputFile> inputs = {};
};

/// The freedom that turns about the z axis of a joint that can carry bearings; -1 if it has none.
int TurnAboutAxis(JointType type);

/// What came out for the bearings of one joint.
struct BearingOutcome {
  int joint = -1;          ///< index in Mechanism::joints
  JointBearings bearings;  ///< chosen, with reasons
};

/// What a study came to: its loads, its simulation and its bearings.
struct StudyOutcome {
  LoadStudyResult loads;                       ///< at every pose
  std::optional<SimulationResult> simulation;  ///< of a study that has one; without its loads
  std::vector<BearingOutcome> bearings;        ///< in the order of StudyFile::bearings
  std::vector<std::string> warnings;           ///< of loads and bearings together
};

/// What a study simulates: its request, or none of it where there is none, with what the study says
/// of it elsewhere.
Simulation SimulationOf(const StudyFile& file);

/// Runs the loads, of its motion or of its history, or the simulation, and chooses the bearings. Of
/// the options a simulation takes the progress, in poses.
/// @throws as RunLoadStudy and Simulate; std::invalid_argument for bearings at a joint that cannot
/// have them.
StudyOutcome RunStudy(const StudyFile& file, const LoadStudyOptions& options);

}  // namespace vmech
