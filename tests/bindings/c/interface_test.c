/* What vmech.h promises, against closed forms: a pendulum, an arm of two links in a plane. The
 * argument is the folder of examples. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <vmech.h>

static int failures = 0;

static void Expect(int met, const char* what, const char* detail) {
  if (met) return;
  ++failures;
  printf("NOT MET: %s (%s)\n", what, detail);
}

static void Near(double value, double expected, double tolerance, const char* what) {
  char detail[80];
  snprintf(detail, sizeof detail, "%.15g, expected %.15g", value, expected);
  Expect(fabs(value - expected) <= tolerance, what, detail);
}

static void Is(vmech_status status, vmech_status expected, const char* what, const char* message) {
  char detail[400];
  snprintf(detail, sizeof detail, "status %d, expected %d: %s", (int)status, (int)expected,
           message);
  Expect(status == expected, what, detail);
}

static const double kMass = 0.4, kArm = 0.05, kSpeed = 20, kGravity = 9.81;

/* A bob on a pin, its grasp in its centre of gravity. */
static vmech_mechanism* Pendulum(void) {
  vmech_mechanism* m = vmech_mechanism_new("pendulum");
  const vmech_link frame = {sizeof frame, "frame", 0, {0}, {0}};
  const vmech_link bob = {sizeof bob, "bob", kMass, {kArm, 0, 0}, {0}};
  const double gravity[3] = {0, -kGravity, 0};
  vmech_joint pin;
  vmech_anchor tip;
  memset(&pin, 0, sizeof pin);
  memset(&tip, 0, sizeof tip);
  pin.struct_size = sizeof pin;
  pin.name = "pin";
  pin.first.link = vmech_add_link(m, &frame);
  pin.second.link = vmech_add_link(m, &bob);
  Expect(vmech_add_joint(m, &pin) == 0, "the joint's index", vmech_mechanism_message(m));
  tip.link = pin.second.link;
  tip.origin[0] = kArm;
  Expect(vmech_add_grasp(m, "tip", &tip, 1) == 0, "the grasp's index", vmech_mechanism_message(m));
  vmech_set_gravity(m, gravity);
  return m;
}

/* Turned at a constant speed: the pin pulls to the centre and bears the weight. */
static vmech_study* Turning(const vmech_mechanism* pendulum) {
  static const double times[3] = {0, 0.01, 0.02};
  vmech_study* study = vmech_study_new(pendulum);
  const vmech_drive drive = {sizeof drive, 0, 0, 0, kSpeed, 0, 0, NULL, NULL};
  vmech_study_add_drive(study, &drive);
  vmech_study_set_times(study, times, 3, 0);
  return study;
}

/* Bears an upward force of 1 N at its tip beside its weight. */
static void LoadsOfAPendulum(void) {
  static const double tip[3] = {0.05, 0, 0}, push[6] = {0, 1, 0, 0, 0, 0};
  vmech_mechanism* m = Pendulum();
  vmech_study* study = Turning(m);
  vmech_study_add_load(study, 1, tip, push, 0);
  vmech_result* result = vmech_study_run(study, NULL);
  vmech_array w = {.struct_size = sizeof w};
  Is(vmech_result_array(result, VMECH_WRENCHES, &w), VMECH_OK, "loads of a pendulum",
     vmech_result_message(result));
  Expect(w.rank == 3 && w.shape[0] == 3 && w.shape[1] == 1 && w.shape[2] == 6, "shape", "");
  for (size_t pose = 0; pose < 3 && w.data != NULL; ++pose) {
    const double angle = kSpeed * 0.01 * (double)pose, pull = kMass * kArm * kSpeed * kSpeed;
    Near(w.data[6 * pose], -pull * cos(angle), 1e-12, "pin force x [N]");
    Near(w.data[6 * pose + 1], -pull * sin(angle) + kMass * kGravity - 1, 1e-12, "pin force y [N]");
  }
  struct {
    double number, other;
  } apart[3 * 6];
  const ptrdiff_t strides[3] = {6 * sizeof apart[0], 0, sizeof apart[0]};
  apart[7].other = 5;
  vmech_result_copy(result, VMECH_WRENCHES, &apart[0].number, strides);
  Expect(apart[7].number == w.data[7] && apart[7].other == 5, "numbers with strides", "");
  double force[3];
  vmech_result_copy(result, VMECH_DRIVE_FORCES, force, NULL);
  Near(force[0], kArm * (kMass * kGravity - 1), 1e-12, "torque of the drive [N m]");
  vmech_array peaks = {.struct_size = sizeof peaks};
  vmech_result_array(result, VMECH_PEAKS, &peaks);
  Near(peaks.data[0], kMass * kArm * kSpeed * kSpeed, 1e-12, "largest pin force along x [N]");
  Expect(vmech_result_certainty(result, 0, 0) == VMECH_CERTAIN, "certainty", "");
  Expect(vmech_result_certainty(result, 1, 0) == -1, "certainty of no joint", "");
  vmech_result_free(result);
  vmech_study_free(study);
  vmech_mechanism_free(m);
}

static int32_t Stop(void* user, size_t poses) {
  *(size_t*)user = poses;
  return 0;
}

static void FailuresAreTold(void) {
  vmech_mechanism* none = vmech_mechanism_open("no such file.yaml");
  vmech_study* of_none = vmech_study_new(none);
  vmech_result* result = vmech_study_run(of_none, NULL);
  Is(vmech_result_status(result), VMECH_FILE_ERROR, "no file", vmech_result_message(result));
  Expect(strstr(vmech_result_message(result), "no such file.yaml") != NULL, "names the file",
         vmech_result_message(result));
  Expect(vmech_mechanism_count(none, VMECH_JOINTS) == 0, "joints of no mechanism", "");
  vmech_array array = {.struct_size = sizeof array};
  Is(vmech_result_array(result, VMECH_WRENCHES, &array), VMECH_FILE_ERROR, "no array", "");
  Expect(array.data == NULL, "no data", "");
  vmech_result_free(result);
  vmech_study_free(of_none);
  vmech_mechanism_free(none);

  vmech_mechanism* text = vmech_mechanism_parse("vmech: \"1.0\"\nlinks: 3\n", "typed.yaml");
  Is(vmech_mechanism_status(text), VMECH_FILE_ERROR, "a wrong text", "");
  Expect(strstr(vmech_mechanism_message(text), "typed.yaml:2:") != NULL, "names the line",
         vmech_mechanism_message(text));
  vmech_mechanism_free(text);

  Is(vmech_study_status(NULL), VMECH_OUT_OF_MEMORY, "no handle", vmech_study_message(NULL));
  vmech_study_free(NULL);
  vmech_mechanism* null = vmech_mechanism_open(NULL);
  Is(vmech_mechanism_status(null), VMECH_INVALID, "path NULL", vmech_mechanism_message(null));
  vmech_mechanism_free(null);

  vmech_mechanism* m = Pendulum();
  vmech_study* study = Turning(m);
  size_t poses = 0;
  const vmech_run_options stops = {sizeof stops, 1, Stop, &poses};
  result = vmech_study_run(study, &stops);
  Is(vmech_result_status(result), VMECH_INTERRUPTED, "stopped", vmech_result_message(result));
  Expect(poses > 0, "poses that were done", "");
  vmech_result_free(result);
  const vmech_drive nowhere = {sizeof nowhere, 5, 0, 0, 1, 0, 0, NULL, NULL};
  vmech_study_add_drive(study, &nowhere);
  result = vmech_study_run(study, NULL);
  Is(vmech_result_status(result), VMECH_INVALID, "a drive nowhere", vmech_result_message(result));
  vmech_result_free(result);
  vmech_study_free(study);
  vmech_mechanism_free(m);
}

/* A program of a later version sets fields that this library does not know. */
static void StructuresOfOtherVersions(void) {
  struct {
    vmech_link link;
    double later;
  } given = {{sizeof given, "bar", 1, {0}, {0}}, 0};
  vmech_mechanism* m = vmech_mechanism_new("m");
  Expect(vmech_add_link(m, &given.link) == 0, "unknown fields of zero", vmech_mechanism_message(m));
  given.later = 1;
  Expect(vmech_add_link(m, &given.link) == -1, "an unknown field", "");
  Is(vmech_mechanism_status(m), VMECH_INVALID, "an unknown field", vmech_mechanism_message(m));
  vmech_mechanism_free(m);
  m = vmech_mechanism_new("m");
  given.link.struct_size = offsetof(vmech_link, center); /* an earlier one, without the centre */
  given.link.center[0] = 7;
  Expect(vmech_add_link(m, &given.link) == 0, "fewer fields", vmech_mechanism_message(m));
  given.link.struct_size = 0;
  Expect(vmech_add_link(m, &given.link) == -1, "no size", "");
  vmech_mechanism_free(m);
}

/* An arm of two links a, b in the plane reaches r by the elbow cos(q2) = (r^2 - a^2 - b^2) / 2ab.
 */
static const char* const kArmText =
    "vmech: \"1.0\"\n"
    "name: arm\n"
    "units: {length: m, angle: rad}\n"
    "gravity: [0, 0, 0]\n"
    "ground: base\n"
    "links:\n"
    "  base:\n    anchors: {shoulder: {origin: [0, 0, 0]}}\n"
    "  upper:\n    anchors: {shoulder: {origin: [0, 0, 0]}, elbow: {origin: [0.3, 0, 0]}}\n"
    "  lower:\n    anchors: {elbow: {origin: [0, 0, 0]}}\n"
    "joints:\n"
    "  shoulder: {type: revolute, connects: [base/shoulder, upper/shoulder], start: 0.1}\n"
    "  elbow: {type: revolute, connects: [upper/elbow, lower/elbow], start: 0.5}\n"
    "grasps:\n"
    "  hand: {link: lower, origin: [0.2, 0, 0], kind: point}\n";

static void PosesOfAnArm(void) {
  vmech_mechanism* arm = vmech_mechanism_parse(kArmText, "arm.yaml");
  Is(vmech_mechanism_status(arm), VMECH_OK, "the arm", vmech_mechanism_message(arm));
  Expect(vmech_mechanism_find(arm, VMECH_FREEDOMS, "elbow") == 1, "a freedom by name", "");
  const char* third = vmech_mechanism_name(arm, VMECH_LINKS, 2);
  Expect(third != NULL && strcmp(third, "lower") == 0, "a link's name", "");
  Expect(vmech_mechanism_name(arm, VMECH_LINKS, 3) == NULL, "no fourth link", "");
  const double elbow = acos((0.4 * 0.4 - 0.3 * 0.3 - 0.2 * 0.2) / (2 * 0.3 * 0.2));

  vmech_ik_options ask;
  memset(&ask, 0, sizeof ask);
  ask.struct_size = sizeof ask;
  ask.hand.position[0] = 0.4;
  ask.hand.rotation[0] = ask.hand.rotation[4] = ask.hand.rotation[8] = 1;
  vmech_result* result = vmech_ik(arm, &ask);
  double q[4], error[6];
  Is(vmech_result_copy(result, VMECH_POSITIONS, q, NULL), VMECH_OK, "inverse kinematics",
     vmech_result_message(result));
  Near(q[1], elbow, 1e-8, "elbow [rad]");
  Near(q[0], -atan2(0.2 * sin(elbow), 0.3 + 0.2 * cos(elbow)), 1e-8, "shoulder [rad]");
  vmech_array links = {.struct_size = sizeof links};
  vmech_result_array(result, VMECH_LINK_POSITIONS, &links);
  const double* lower = (const double*)((const char*)links.data + 2 * links.strides[1]);
  Near(lower[0], 0.3 * cos(q[0]), 1e-12, "the elbow's place [m]");
  Near(lower[1], 0.3 * sin(q[0]), 1e-12, "the elbow's place [m]");
  vmech_result_array(result, VMECH_LINK_ROTATIONS, &links);
  const char* rotation = (const char*)links.data + links.strides[1];
  Near(*(const double*)(rotation + links.strides[2]), sin(q[0]), 1e-12, "R of the upper link");
  Expect(vmech_result_array(result, VMECH_TIMES, &links) == VMECH_OK && links.data == NULL,
         "no times", "");
  vmech_result_free(result);

  ask.hand.position[0] = 0.7; /* 0.2 m out of reach */
  result = vmech_ik(arm, &ask);
  vmech_result_copy(result, VMECH_HAND_ERRORS, error, NULL);
  Near(error[0], 0.2, 1e-6, "out of reach [m]");
  vmech_result_free(result);
  ask.solver = "magic";
  result = vmech_ik(arm, &ask);
  Is(vmech_result_status(result), VMECH_INVALID, "no solver", vmech_result_message(result));
  vmech_result_free(result);

  vmech_modes_options modes;
  memset(&modes, 0, sizeof modes);
  modes.struct_size = sizeof modes;
  modes.with_hand = 1;
  modes.hand = ask.hand;
  modes.hand.position[0] = 0.4;
  modes.patience = 50;
  result = vmech_assembly_modes(arm, &modes);
  vmech_array found = {.struct_size = sizeof found};
  vmech_result_array(result, VMECH_POSITIONS, &found);
  Expect(found.data != NULL && found.shape[0] == 2, "two modes", vmech_result_message(result));
  if (found.data != NULL && found.shape[0] == 2) {
    Near(fabs(found.data[1]), elbow, 1e-9, "elbow of a mode");
    Near(found.data[3], -found.data[1], 1e-9, "and of its mirror image");
  }
  vmech_result_free(result);
  vmech_mechanism_free(arm);
}

/* A hand at rest comes to carry what keeps the pendulum level. */
static void HeldPendulum(void) {
  vmech_mechanism* m = Pendulum();
  vmech_tick_options options;
  memset(&options, 0, sizeof options);
  options.struct_size = sizeof options;
  options.period = 1e-3;
  for (int i = 0; i < 3; ++i) {
    options.stiffness[i] = 1e4;
    options.damping[i] = 100;
  }
  vmech_tick* tick = vmech_tick_new(m, &options);
  vmech_pose hand;
  Is(vmech_tick_grasp(tick, &hand), VMECH_OK, "a tick", vmech_tick_message(tick));
  double wrench[6], joints[6];
  vmech_status status = VMECH_OK;
  for (int i = 0; i < 3000 && status == VMECH_OK; ++i) {
    status = vmech_tick_step(tick, &hand, wrench);
  }
  Is(status, VMECH_OK, "3000 steps", "");
  Near(wrench[1], -kMass * kGravity, 1e-3, "the hand feels the weight [N]");
  vmech_tick_wrenches(tick, joints, 1);
  Near(joints[1], 0, 1e-2, "nothing is left for the pin [N]");
  Is(vmech_tick_wrenches(tick, joints, 0), VMECH_INVALID, "no room", "");
  hand.position[0] = NAN;
  Is(vmech_tick_step(tick, &hand, wrench), VMECH_NO_SOLUTION, "a hand that is no number", "");
  Expect(wrench[1] == 0, "no wrench then", "");
  vmech_tick_free(tick);
  options.grasp = 1;
  tick = vmech_tick_new(m, &options);
  Is(vmech_tick_status(tick), VMECH_INVALID, "no grasp", vmech_tick_message(tick));
  vmech_tick_free(tick);
  vmech_mechanism_free(m);
}

/* Across the plane of a four-bar linkage statics leaves forces open; its bearings are chosen. */
static void FourBarStudy(const char* examples) {
  char path[400];
  snprintf(path, sizeof path, "%s/four-bar-study.yaml", examples);
  vmech_study* study = vmech_study_open(path);
  vmech_result* result = vmech_study_run(study, NULL);
  Is(vmech_result_status(result), VMECH_OK, "the study", vmech_result_message(result));
  Expect(vmech_result_certainty(result, 0, 0) == VMECH_CERTAIN, "fx is certain", "");
  Expect(vmech_result_certainty(result, 0, 2) == VMECH_NOT_DETERMINED, "fz is not", "");
  vmech_bearings b = {.struct_size = sizeof b};
  Is(vmech_result_bearings(result, 0, &b), VMECH_OK, "bearings", "");
  Expect(b.is_met && b.count == 2 && b.designation[1] != NULL, "two bearings", "");
  Expect(b.life_hours > 0 && b.life_hours < b.bearing_hours[0], "a pair lives shorter", "");
  Is(vmech_result_bearings(result, 2, &b), VMECH_INVALID, "no third joint has bearings", "");
  vmech_result_free(result);
  vmech_study_free(study);
}

/* What goes in by the drive is what becomes of it; a motion that is given has no energies. */
static void PowerOfASliderCrank(const char* examples) {
  char path[400];
  snprintf(path, sizeof path, "%s/slider-crank-study.yaml", examples);
  vmech_study* study = vmech_study_open(path);
  vmech_result* result = vmech_study_run(study, NULL);
  vmech_array a = {.struct_size = sizeof a};
  vmech_result_array(result, VMECH_POWER_ERRORS, &a);
  for (size_t i = 0; a.data != NULL && i < a.shape[0]; ++i) Near(a.data[i], 0, 1e-9, "power");
  Expect(vmech_result_array(result, VMECH_ENERGIES, &a) == VMECH_OK && a.data == NULL,
         "a study of loads has no energies", "");
  vmech_result_free(result);
  vmech_study_free(study);
}

static const char* const kBar =
    "vmech: '1.0'\nname: bar\nunits: {length: mm, angle: deg}\ngravity: [0, 0, 0]\nground: a\n"
    "parameters: {length: 50, mass: 2 kg}\n"
    "links:\n  a: {anchors: {pin: {}}}\n"
    "  b: {mass: mass, anchors: {pin: {}, tip: {origin: [length, 0, 0]}}}\n"
    "joints: {pin: {type: revolute, connects: [a/pin, b/pin]}}\n"
    "grasps: {tip: {link: b, origin: [length, 0, 0], kind: point}}\n";

/* Values of parameters that go before those of the file, and what they are then. */
static void ParametersOfAText(void) {
  static const char* const settings[2] = {"length=7 cm", "mass=0.5"};
  static const char* const wrong[1] = {"length=3 kg"};
  static const char* const none[1] = {"length"};
  const vmech_read_options options = {sizeof options, settings, 2};
  const vmech_read_options bad = {sizeof bad, wrong, 1}, empty = {sizeof empty, none, 1};
  vmech_parameter p = {.struct_size = sizeof p};
  vmech_mechanism* as_it_is = vmech_mechanism_parse(kBar, "bar");
  Is(vmech_mechanism_parameter(as_it_is, 0, &p), VMECH_OK, "a parameter", "");
  Expect(p.name != NULL && strcmp(p.name, "length") == 0, "its name", "");
  Near(p.value, 50, 0, "its value");
  vmech_mechanism_free(as_it_is);
  vmech_mechanism* set = vmech_mechanism_parse_with(kBar, "bar", &options);
  Is(vmech_mechanism_parameter(set, 0, &p), VMECH_OK, "set", vmech_mechanism_message(set));
  Near(p.value, 7, 1e-15, "length [cm]");
  Expect(p.unit != NULL && strcmp(p.unit, "cm") == 0, "its unit, of the setting", "");
  Is(vmech_mechanism_parameter(set, 1, &p), VMECH_OK, "set", "");
  Near(p.value, 0.5, 1e-15, "mass [kg]");
  Is(vmech_mechanism_parameter(set, 2, &p), VMECH_INVALID, "beyond the last", "");
  vmech_ik_options ik;
  memset(&ik, 0, sizeof ik);
  ik.struct_size = sizeof ik;
  ik.hand.position[0] = 0.042;
  ik.hand.position[1] = 0.056;
  ik.hand.rotation[0] = ik.hand.rotation[4] = ik.hand.rotation[8] = 1;
  vmech_result* pose = vmech_ik(set, &ik);
  vmech_array errors = {.struct_size = sizeof errors};
  vmech_result_array(pose, VMECH_HAND_ERRORS, &errors);
  for (int k = 0; k < 3 && errors.data != NULL; ++k) Near(errors.data[k], 0, 1e-9, "reach");
  Expect(errors.data != NULL, "a bar of 70 mm reaches", vmech_result_message(pose));
  vmech_result_free(pose);
  vmech_mechanism_free(set);
  vmech_mechanism* failed = vmech_mechanism_parse_with(kBar, "bar", &bad);
  Is(vmech_mechanism_status(failed), VMECH_FILE_ERROR, "a mass for a length", "");
  Expect(strstr(vmech_mechanism_message(failed), "a mass, where a length is asked") != NULL,
         "it is named", vmech_mechanism_message(failed));
  vmech_mechanism_free(failed);
  failed = vmech_mechanism_parse_with(kBar, "bar", &empty);
  Is(vmech_mechanism_status(failed), VMECH_INVALID, "a name alone", "");
  vmech_mechanism_free(failed);
}

/* A study takes settings for its mechanism. */
static void ParametersOfAStudy(const char* examples) {
  static const char* const settings[1] = {"coupler=0.8"};
  const vmech_read_options options = {sizeof options, settings, 1};
  char path[400];
  vmech_parameter p = {.struct_size = sizeof p};
  snprintf(path, sizeof path, "%s/../../studies/examples/crank-rocker-study.yaml", examples);
  vmech_study* study = vmech_study_open_with(path, &options);
  int found = 0;
  for (size_t i = 0; vmech_study_parameter(study, i, &p) == VMECH_OK; ++i) {
    if (strcmp(p.name, "coupler") != 0) continue;
    Near(p.value, 0.8, 1e-15, "coupler [m]");
    found = 1;
  }
  Expect(found, "the coupler is a parameter", vmech_study_message(study));
  vmech_study_free(study);
}

int main(int count, char** arguments) {
  const char* examples = count > 1 ? arguments[1] : ".";
  LoadsOfAPendulum();
  FailuresAreTold();
  StructuresOfOtherVersions();
  PosesOfAnArm();
  HeldPendulum();
  FourBarStudy(examples);
  PowerOfASliderCrank(examples);
  ParametersOfAText();
  ParametersOfAStudy(examples);
  printf(failures == 0 ? "all as expected\n" : "%d NOT as expected\n", failures);
  return failures != 0;
}
