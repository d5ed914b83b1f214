#pragma once

#include <cstddef>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "vmech.h"
#include "vmech/base/pose.h"
#include "vmech/bindings/shared/computed.h"
#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/mechanism.h"
#include "vmech/studies/study.h"

/// What every handle begins with.
struct HandleState {
  vmech_status status = VMECH_OK;
  std::string message;
};

struct vmech_mechanism : HandleState {
  vmech::Mechanism mechanism;
  std::vector<std::string> freedoms;               ///< names
  std::vector<vmech::StatedParameter> parameters;  ///< of the file
};

struct vmech_study : HandleState {
  vmech::StudyFile file;
};

struct vmech_result : HandleState {
  vmech::Computed computed;
};

namespace vmech::c {

/// The status for the exception that is being handled, and its text.
vmech_status Describe(std::string* message) noexcept;

/// Does something to a handle that has not failed; an exception makes it fail.
template <typename Handle, typename Work>
vmech_status Do(Handle* handle, Work work) noexcept {
  if (handle == nullptr) return VMECH_OUT_OF_MEMORY;
  if (handle->status != VMECH_OK) return handle->status;
  try {
    work();
  } catch (...) {
    handle->status = Describe(&handle->message);
  }
  return handle->status;
}

/// A new handle, filled by `work`, whatever becomes of that.
template <typename Handle, typename Work>
Handle* Make(Work work) noexcept {
  std::unique_ptr<Handle> handle;
  try {
    handle = std::make_unique<Handle>();
  } catch (...) {
    return nullptr;
  }
  Do(handle.get(), [&] { work(handle.get()); });
  return handle.release();
}

/// A handle failed, and with it one that was to be made of it.
struct FailedBefore : std::exception {
  explicit FailedBefore(const HandleState* state);
  const char* what() const noexcept override { return message.c_str(); }

  vmech_status status = VMECH_OUT_OF_MEMORY;
  std::string message;
};

/// @throws FailedBefore
template <typename Handle>
const Handle& Sound(const Handle* handle) {
  if (handle == nullptr || handle->status != VMECH_OK) throw FailedBefore(handle);
  return *handle;
}

inline vmech_status StatusOf(const HandleState* handle) noexcept {
  return handle == nullptr ? VMECH_OUT_OF_MEMORY : handle->status;
}
const char* MessageOf(const HandleState* handle) noexcept;

/// @throws std::invalid_argument if a pointer that must not be NULL is.
void RequirePointer(const char* name, const void* pointer);

/// @throws std::invalid_argument for a size that no version has, or fields that this one does not
///         know and that are not zero.
void RequireSize(const char* name, const void* given, size_t size, size_t known);

/// A structure of the program's, which may have been compiled with an earlier or later version.
template <typename Struct>
Struct Read(const char* name, const Struct* given) {
  RequirePointer(name, given);
  RequireSize(name, given, given->struct_size, sizeof(Struct));
  Struct read{};
  std::memcpy(&read, given, given->struct_size < sizeof(Struct) ? given->struct_size : sizeof read);
  return read;
}

/// The same where NULL stands for every default.
template <typename Struct>
Struct ReadOrDefault(const char* name, const Struct* given) {
  return given == nullptr ? Struct{} : Read(name, given);
}

/// As much of a structure as the program knows of it. False where it says no size.
template <typename Struct>
bool Write(Struct value, Struct* to) noexcept {
  if (to == nullptr || to->struct_size < sizeof to->struct_size) return false;
  value.struct_size = to->struct_size;
  std::memcpy(to, &value, to->struct_size < sizeof(Struct) ? to->struct_size : sizeof value);
  return true;
}

/// @throws std::invalid_argument for a setting that is none.
std::vector<ParameterSetting> SettingsOf(const vmech_read_options* options);

/// One of several parameters.
vmech_status ParameterAt(const HandleState* handle, const std::vector<StatedParameter>& parameters,
                         size_t index, vmech_parameter* parameter) noexcept;

inline Vector3d VectorOf(const double numbers[3]) {
  return {numbers[0], numbers[1], numbers[2]};
}
inline Posed PoseOf(const vmech_pose& pose) {
  const double* r = pose.rotation;
  Posed X;
  X.R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  X.p = VectorOf(pose.position);
  return X;
}

}  // namespace vmech::c
