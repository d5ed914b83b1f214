/* Bearing loads of the four-bar linkage, turned once at 60 rpm. */
#include <stdio.h>
#include <vmech.h>

int main(int count, char** arguments) {
  vmech_study* study = vmech_study_open(count > 1 ? arguments[1] : "four-bar-study.yaml");
  vmech_mechanism* mechanism = vmech_study_mechanism(study);
  vmech_result* result = vmech_study_run(study, NULL);
  const int failed = vmech_result_status(result) != VMECH_OK;
  if (failed) fprintf(stderr, "%s\n", vmech_result_message(result));

  vmech_array peaks = {.struct_size = sizeof peaks};
  vmech_result_array(result, VMECH_PEAKS, &peaks);
  for (size_t j = 0; peaks.data != NULL && j < peaks.shape[0]; ++j) {
    const double* peak = peaks.data + 6 * j; /* fx fy fz mx my mz */
    printf("%-14s largest force %8.3f N along x %8.3f N along y\n",
           vmech_mechanism_name(mechanism, VMECH_JOINTS, j), peak[0], peak[1]);
  }
  vmech_bearings b = {.struct_size = sizeof b};
  for (size_t i = 0; vmech_result_bearings(result, i, &b) == VMECH_OK; ++i) {
    printf("%-14s bearings %s and %s live %.0f h\n",
           vmech_mechanism_name(mechanism, VMECH_JOINTS, (size_t)b.joint), b.designation[0],
           b.designation[1], b.life_hours);
  }
  vmech_result_free(result);
  vmech_mechanism_free(mechanism);
  vmech_study_free(study);
  return failed;
}
