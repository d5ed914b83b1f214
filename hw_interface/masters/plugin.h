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
  double mass, damping, coulomb, resolution, peak, max_speed; /* kg, m, s, N; of rotations rad */
} vmech_plugin_physics;

/* What the device states of itself. */
typedef struct {
  char name[64];                                                     /* for reports, ends with 0 */
  double period;                                                     /* [s], > 0 */
  double delay;                                                      /* [s] */
  int32_t senses_twist, senses_gripper, senses_wrench, has_dead_man; /* 1: the state has it */
  vmech_plugin_physics linear, angular; /* of positions; of rotations */
} vmech_plugin_info;

/* What the device senses, at a time of its own clock. */
typedef struct {
  uint64_t sequence;                /* grows by one per sample */
  int64_t device_time_ns;           /* of the device's clock */
  uint32_t buttons;                 /* bit by bit, pressed */
  int32_t dead_man, emergency_stop; /* 1: held; 1: pressed */
  double position[3];               /* of Ho in D [m] */
  double rotation[9];               /* row after row, R_DH */
  double twist[6];                  /* [v; w] of Ho, axes of D [m/s, rad/s] */
  double applied_wrench[6];         /* of the handle on the hand at Ho, axes of D [N, N m] */
  double gripper_opening;           /* [rad] */
} vmech_plugin_state;

/* What the device is to exert, and until when. */
typedef struct {
  uint64_t sequence;      /* grows by one per command */
  int64_t valid_until_ns; /* of the clock whose time `read` is given */
  double wrench[6];       /* all zero: motors off */
  double gripper_torque;  /* [N m], positive opens */
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
  uint32_t version; /* VMECH_PLUGIN_VERSION */
  void* device;     /* whatever the plug-in likes; the functions are given it */
  /* Opens the link and fills `info`. */
  int (*configure)(void* device, vmech_plugin_info* info, char* error, size_t error_size);
  int (*activate)(void* device, char* error, size_t error_size); /* motors on */
  void (*deactivate)(void* device);                              /* motors off */
  /* Back from a fault, motors off. */
  int (*recover)(void* device, char* error, size_t error_size);
  /* The newest sample, without waiting for one. */
  int (*read)(void* device, int64_t now_ns, vmech_plugin_state* state);
  /* Takes the newest command, without waiting. */
  void (*write)(void* device, const vmech_plugin_command* command);
  void (*destroy)(void* device); /* closes the link and frees the device */
} vmech_plugin;

/* Exported by the plug-in. `parameters` is the text that the user gave for it. */
int vmech_plugin_create(const char* parameters, vmech_plugin* plugin, char* error,
                        size_t error_size);

#ifdef __cplusplus
}
#endif
