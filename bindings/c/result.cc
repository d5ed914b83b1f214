#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "handles.h"

namespace vmech::c {
namespace {

// The order of the two is one.
static_assert(static_cast<int>(ArrayKind::kTimes) == VMECH_TIMES);
static_assert(static_cast<int>(ArrayKind::kLinkPositions) == VMECH_LINK_POSITIONS);
static_assert(static_cast<int>(ArrayKind::kPeaks) == VMECH_PEAKS);
static_assert(kQuantities.size() == VMECH_PEAKS + 1);
static_assert(static_cast<int>(Certainty::kSingular) == VMECH_SINGULAR);

/// Without data where there is no such quantity.
NumberArray ArrayOf(const vmech_result* result, vmech_quantity quantity) {
  if (result == nullptr || quantity < VMECH_TIMES || quantity > VMECH_PEAKS) return {};
  return result->computed.Array(static_cast<ArrayKind>(quantity));
}

/// A result has numbers, all or, where it stopped early, some.
vmech_status StatusOfNumbers(const vmech_result* result, vmech_quantity quantity) {
  if (result == nullptr) return VMECH_OUT_OF_MEMORY;
  if (quantity < VMECH_TIMES || quantity > VMECH_PEAKS) return VMECH_INVALID;
  return result->computed.pose_count() > 0 ? VMECH_OK : result->status;
}

std::array<ptrdiff_t, NumberArray::kMaxRank> DenseStrides(const NumberArray& array) {
  std::array<ptrdiff_t, NumberArray::kMaxRank> strides{};
  ptrdiff_t stride = sizeof(double);
  for (size_t i = array.rank; i-- > 0;) {
    strides[i] = stride;
    stride *= static_cast<ptrdiff_t>(array.shape[i]);
  }
  return strides;
}

/// Index after index, from the `index`-th on.
void Copy(const NumberArray& from, size_t index, const char* source, const ptrdiff_t* strides,
          char* to) {
  if (index == from.rank) {
    std::memcpy(to, source, sizeof(double));
    return;
  }
  for (size_t i = 0; i < from.shape[index]; ++i) {
    const auto step = static_cast<ptrdiff_t>(i);
    Copy(from, index + 1, source + step * from.strides[index], strides, to + step * strides[index]);
  }
}

vmech_bearings BearingsOf(const BearingOutcome& outcome) {
  vmech_bearings bearings{};
  const JointBearings& joint = outcome.bearings;
  bearings.joint = outcome.joint;
  bearings.is_met = joint.met();
  bearings.is_certain = joint.certainty == LoadCertainty::kCertain;
  bearings.life_hours = joint.system_life_hours;
  bearings.count = static_cast<int32_t>(std::min<size_t>(2, joint.selections.size()));
  for (int32_t i = 0; i < bearings.count; ++i) {
    const Candidate* best = joint.selections[i].best();
    if (best == nullptr) continue;
    bearings.designation[i] = best->bearing.designation.c_str();
    if (!best->rating) continue;
    bearings.bearing_hours[i] = best->rating->modified_life_hours;
    bearings.static_safety[i] = best->rating->static_safety;
  }
  return bearings;
}

}  // namespace
}  // namespace vmech::c

using namespace vmech::c;

const char* vmech_result_warning(const vmech_result* result, size_t index) {
  if (result == nullptr || index >= result->computed.warnings().size()) return nullptr;
  return result->computed.warnings()[index].c_str();
}

vmech_status vmech_result_array(const vmech_result* result, vmech_quantity quantity,
                                vmech_array* array) {
  const vmech::NumberArray numbers = ArrayOf(result, quantity);
  vmech_array given{};
  given.data = numbers.data;
  given.rank = numbers.rank;
  std::copy(numbers.shape.begin(), numbers.shape.end(), given.shape);
  std::copy(numbers.strides.begin(), numbers.strides.end(), given.strides);
  return Write(given, array) ? StatusOfNumbers(result, quantity) : VMECH_INVALID;
}

vmech_status vmech_result_copy(const vmech_result* result, vmech_quantity quantity, double* to,
                               const ptrdiff_t* strides) {
  const vmech_status status = StatusOfNumbers(result, quantity);
  if (status != VMECH_OK) return status;
  const vmech::NumberArray numbers = ArrayOf(result, quantity);
  if (to == nullptr || numbers.data == nullptr) return VMECH_INVALID;
  const auto dense = DenseStrides(numbers);
  Copy(numbers, 0, reinterpret_cast<const char*>(numbers.data),
       strides == nullptr ? dense.data() : strides, reinterpret_cast<char*>(to));
  return VMECH_OK;
}

vmech_certainty vmech_result_certainty(const vmech_result* result, size_t joint, size_t component) {
  if (result == nullptr || component > 5) return -1;
  const auto& certainty = result->computed.certainty();
  return joint < certainty.size() ? static_cast<vmech_certainty>(certainty[joint][component]) : -1;
}

vmech_status vmech_result_bearings(const vmech_result* result, size_t index,
                                   vmech_bearings* bearings) {
  if (result == nullptr) return VMECH_OUT_OF_MEMORY;
  const auto& outcomes = result->computed.outcome().bearings;
  const bool there = index < outcomes.size();
  return there && Write(BearingsOf(outcomes[index]), bearings) ? VMECH_OK : VMECH_INVALID;
}
