#include "handles.h"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "vmech/bindings/shared/parametric.h"
#include "vmech/mechanisms/files/file_errors.h"

namespace vmech::c {
namespace {

constexpr const char* kNoMemory = "no memory is left, or no handle was given";

/// A status, and its text as far as there is memory for it.
vmech_status Say(vmech_status status, const char* text, std::string* message) noexcept {
  try {
    *message = text;
  } catch (const std::bad_alloc&) {
    message->clear();
  }
  return status;
}

}  // namespace

vmech_status Describe(std::string* message) noexcept {
  try {
    throw;
  } catch (const FailedBefore& error) {
    return Say(error.status, error.what(), message);
  } catch (const FileErrors& error) {
    return Say(VMECH_FILE_ERROR, error.what(), message);
  } catch (const std::invalid_argument& error) {
    return Say(VMECH_INVALID, error.what(), message);
  } catch (const std::runtime_error& error) {
    return Say(VMECH_NO_SOLUTION, error.what(), message);
  } catch (const std::bad_alloc&) {
    return Say(VMECH_OUT_OF_MEMORY, kNoMemory, message);
  } catch (const std::exception& error) {
    return Say(VMECH_INTERNAL, error.what(), message);
  } catch (...) {
    return Say(VMECH_INTERNAL, "something that is no exception of C++ was thrown", message);
  }
}

FailedBefore::FailedBefore(const HandleState* state) : message(MessageOf(state)) {
  if (state != nullptr) status = state->status;
}

const char* MessageOf(const HandleState* handle) noexcept {
  if (handle == nullptr) return kNoMemory;
  if (handle->status != VMECH_OK && handle->message.empty()) return kNoMemory;
  return handle->message.c_str();
}

void RequirePointer(const char* name, const void* pointer) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is NULL");
}

void RequireSize(const char* name, const void* given, size_t size, size_t known) {
  constexpr size_t kLargest = 4096;
  if (size < sizeof size || size > kLargest) {
    throw std::invalid_argument(std::string(name) + ".struct_size = " + std::to_string(size) +
                                ", must be the sizeof of the structure");
  }
  const auto* bytes = static_cast<const unsigned char*>(given);
  if (size > known && std::any_of(bytes + known, bytes + size, [](auto b) { return b != 0; })) {
    throw std::invalid_argument(std::string(name) +
                                " has fields that this version of the library does not know: "
                                "install a later libvmech_c, or leave them 0");
  }
}

std::vector<ParameterSetting> SettingsOf(const vmech_read_options* options) {
  const vmech_read_options given = ReadOrDefault("options", options);
  std::vector<std::string> words;
  for (size_t i = 0; i < given.setting_count; ++i) {
    RequirePointer("options.settings", given.settings);
    RequirePointer("options.settings[..]", given.settings[i]);
    words.emplace_back(given.settings[i]);
  }
  return vmech::SettingsOf(words);
}

vmech_status ParameterAt(const HandleState* handle, const std::vector<StatedParameter>& parameters,
                         size_t index, vmech_parameter* parameter) noexcept {
  if (StatusOf(handle) != VMECH_OK) return StatusOf(handle);
  if (index >= parameters.size()) return VMECH_INVALID;
  const StatedParameter& stated = parameters[index];
  const vmech_parameter told{0, stated.name.c_str(), stated.unit.c_str(), stated.figure};
  return Write(told, parameter) ? VMECH_OK : VMECH_INVALID;
}

}  // namespace vmech::c

using vmech::c::MessageOf;
using vmech::c::StatusOf;

const char* vmech_version(void) {
  return VMECH_VERSION;
}

vmech_status vmech_mechanism_status(const vmech_mechanism* mechanism) {
  return StatusOf(mechanism);
}
const char* vmech_mechanism_message(const vmech_mechanism* mechanism) {
  return MessageOf(mechanism);
}
void vmech_mechanism_free(vmech_mechanism* mechanism) {
  delete mechanism;
}

vmech_status vmech_study_status(const vmech_study* study) {
  return StatusOf(study);
}
const char* vmech_study_message(const vmech_study* study) {
  return MessageOf(study);
}
void vmech_study_free(vmech_study* study) {
  delete study;
}

vmech_status vmech_result_status(const vmech_result* result) {
  return StatusOf(result);
}
const char* vmech_result_message(const vmech_result* result) {
  return MessageOf(result);
}
void vmech_result_free(vmech_result* result) {
  delete result;
}
