#pragma once

#include <filesystem>

#include "vmech/hw_interface/masters/master.h"
#include "vmech/hw_interface/masters/plugin.h"

namespace vmech {

/// A master from a shared library with the C entry point of plugin.h.
class PluginMaster : public Master {
 public:
  /// @throws std::runtime_error if the library cannot be loaded, has no entry point, is made for
  ///         another version, or refuses the parameters.
  PluginMaster(const std::filesystem::path& library, const std::string& parameters);
  ~PluginMaster() override;

 private:
  DeviceInfo OnConfigure() override;
  void OnActivate() override;
  void OnDeactivate() noexcept override { plugin_.deactivate(plugin_.device); }
  void OnRecover() override;
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand& command) noexcept override;

  std::string library_name_;
  void* library_;
  vmech_plugin plugin_{};
};

}  // namespace vmech
