#include "vmech/base/late_library.h"

#include <dlfcn.h>
#include <link.h>

#include <stdexcept>

namespace vmech {

LateLibrary::LateLibrary(const std::string& name)
    : handle_(dlopen(("libvmech_" + name + ".so").c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) error_ = dlerror();
}

std::filesystem::path LateLibrary::path() const {
  link_map* map = nullptr;
  const bool known = handle_ != nullptr && dlinfo(handle_, RTLD_DI_LINKMAP, &map) == 0;
  return known ? map->l_name : "";
}

const void* LateLibrary::Find(const char* name) const {
  if (handle_ == nullptr) throw std::logic_error(error_);
  const void* variable = dlsym(handle_, name);
  if (variable == nullptr) throw std::logic_error(dlerror());
  return variable;
}

}  // namespace vmech
