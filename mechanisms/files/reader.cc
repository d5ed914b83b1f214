#include "vmech/mechanisms/files/reader.h"

#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/files/parameters.h"

namespace vmech {

Mechanism ReadMechanism(const std::filesystem::path& path) {
  return ReadMechanism(path, {});
}

Mechanism ReadMechanism(const std::filesystem::path& path,
                        std::span<const ParameterSetting> settings) {
  MechanismSource source(ReadTextFile(path), path.string());
  ApplySettings(settings, path.string(), source.units(), &source.parameters());
  return source.Read();
}

Mechanism ParseMechanism(std::string_view text, const std::string& name) {
  return MechanismSource(text, name).Read();
}

}  // namespace vmech
