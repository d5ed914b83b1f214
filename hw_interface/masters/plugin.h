/* A master in a shared library of its own, for drivers that cannot be part of vmech.
 *
 * The library exports one function, vmech_plugin_create. It fills in a table of functions; all of
 * them are called from one thread at a time. read and write are called at the device's rate from a
 * real-time thread: no heap, no lock, no log. Units are SI, frames as in master.h: D the device's
 * base, H its handle, wrenches [f; m] on the hand, about the handle's origin, in the axes of D.
 */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Grows when a struct below changes. A plug-in writes it into its table; another is refused. */
#define VMECH_PLUGIN_VERSION 1

/* See HandlePhysics in device_info.h; zero is unknown. */
typedef struct {
  double mass, damping, coulomb, resolution, peak, max_speed;
} vmech_plugin_physics;

/* What the device states of itself. */
typedef struct {
  char name[64];
  double period; /* [s], > 0 */
  double delay;  /* [s] */
  int32_t senses_twist, senses_gripper, senses_wrench, has_dead_man;
  vmech_plugin_physics linear, angular;
} vmech_plugin_info;

/* What the device senses, at a time of its own clock. */
typedef struct {
  uint64_t sequence;
  int64_t device_time_ns;
  uint32_t buttons;
  int32_t dead_man, emergency_stop;
  double position[3];
  double rotation[9]; /* row after row, R_DH */
  double twist[6];
  double applied_wrench[6];
  double gripper_opening; /* [rad] */
} vmech_plugin_state;

/* What the device is to exert, and until when. */
typedef struct {
  uint64_t sequence;
  int64_t valid_until_ns; /* of the clock whose time `read` is given */
  double wrench[6];       /* all zero: motors off */
  double gripper_torque;
} vmech_plugin_command;

/* What read returns. */
enum {
  VMECH_PLUGIN_OK = 0,
  VMECH_PLUGIN_NO_NEW_DATA = 1,
  VMECH_PLUGIN_LINK_LOST = 2,
  VMECH_PLUGIN_DEVICE_FAULT = 3
};

/* configure, activate and recover return 0, or write what is wrong into error [error_size]. */
typedef struct {
  uint32_t version;
  void* device;
  int (*configure)(void* device, vmech_plugin_info* info, char* error, size_t error_size);
  int (*activate)(void* device, char* error, size_t error_size);
  void (*deactivate)(void* device);
  int (*recover)(void* device, char* error, size_t error_size);
  int (*read)(void* device, int64_t now_ns, vmech_plugin_state* state);
  void (*write)(void* device, const vmech_plugin_command* command);
  void (*destroy)(void* device);
} vmech_plugin;

/* Exported by the plug-in. `parameters` is the text that the user gave for it. */
int vmech_plugin_create(const char* parameters, vmech_plugin* plugin, char* error,
                        size_t error_size);

#ifdef __cplusplus
}
#endif
