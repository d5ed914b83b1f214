/* A mechanism in the loop of a device, as docs/c.md shows it; the device is a hand that goes 5 mm
 * up within half a second: hand_loop MECHANISM */

#include <stdio.h>
#include <vmech.h>

static int ticks = 0;
static double largest = 0;

/* Half a second of handle, at a millisecond each. */
static int read_handle(vmech_pose* hand) {
  hand->position[1] += 1e-5;
  return ticks++ < 500;
}

static void write_motors(const double wrench[6]) {
  for (int i = 0; i < 3; ++i) largest = wrench[i] > largest ? wrench[i] : largest;
}

int main(int count, char** arguments) {
  if (count != 2) return 1;
  vmech_mechanism* mechanism = vmech_mechanism_open(arguments[1]);
  vmech_tick_options options = {.struct_size = sizeof options,
                                .period = 1e-3,
                                .stiffness = {2000, 2000, 2000},
                                .damping = {20, 20, 20}};
  vmech_tick* tick = vmech_tick_new(mechanism, &options);
  vmech_pose hand;
  double wrench[6];
  vmech_tick_grasp(tick, &hand); /* bring the hand here first */
  while (read_handle(&hand)) {   /* every millisecond */
    if (vmech_tick_step(tick, &hand, wrench) != VMECH_OK) break;
    write_motors(wrench); /* N, N m on the hand, world axes */
  }
  printf("%d ticks, at most %.2f N %s\n", ticks - 1, largest, vmech_tick_message(tick));
  vmech_tick_free(tick);
  vmech_mechanism_free(mechanism);
  return ticks == 501 && largest > 0 ? 0 : 1;
}
