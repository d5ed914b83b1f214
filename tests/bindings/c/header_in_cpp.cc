// The header is C++ too, of every standard, and needs nothing before it.

#include <vmech.h>

#include <cstdio>

int main() {
  std::printf("vmech %s\n", vmech_version());
  return vmech_mechanism_status(nullptr) == VMECH_OUT_OF_MEMORY ? 0 : 1;
}
