/* A plug-in as a driver's author would write it: a handle that stands where its last force points.
 */
#include <stdlib.h>
#include <string.h>

#include "vmech/hw_interface/masters/plugin.h"

struct device {
  double force[3];
  uint64_t sequence;
  int fault;
};

static int configure(void* device, vmech_plugin_info* info, char* error, size_t error_size) {
  (void)device;
  (void)error;
  (void)error_size;
  strcpy(info->name, "example");
  info->period = 2e-3;
  info->linear.damping = 3;
  info->linear.peak = 10;
  return 0;
}

static int start(void* device, char* error, size_t error_size) {
  ((struct device*)device)->fault = 0;
  (void)error;
  (void)error_size;
  return 0;
}

static void stop(void* device) {
  memset(((struct device*)device)->force, 0, 3 * sizeof(double));
}

static int read_state(void* device, int64_t now_ns, vmech_plugin_state* state) {
  struct device* d = (struct device*)device;
  if (d->fault) return VMECH_PLUGIN_DEVICE_FAULT;
  state->sequence = ++d->sequence;
  state->device_time_ns = now_ns;
  memcpy(state->position, d->force, sizeof d->force);
  /* a quarter turn about z */
  state->rotation[1] = -1;
  state->rotation[3] = 1;
  state->rotation[8] = 1;
  return VMECH_PLUGIN_OK;
}

static void write_command(void* device, const vmech_plugin_command* command) {
  struct device* d = (struct device*)device;
  memcpy(d->force, command->wrench, sizeof d->force);
  d->fault = command->wrench[0] > 100;
}

int vmech_plugin_create(const char* parameters, vmech_plugin* plugin, char* error,
                        size_t error_size) {
  if (strcmp(parameters, "broken") == 0) {
    strncpy(error, "no such serial number", error_size - 1);
    return 1;
  }
  if (strcmp(parameters, "old") == 0) return 0; /* a table of version 0 */
  plugin->version = VMECH_PLUGIN_VERSION;
  plugin->device = calloc(1, sizeof(struct device));
  plugin->configure = configure;
  plugin->activate = start;
  plugin->deactivate = stop;
  plugin->recover = start;
  plugin->read = read_state;
  plugin->write = write_command;
  plugin->destroy = free;
  if (strcmp(parameters, "gaps") == 0) plugin->read = NULL;
  return 0;
}
