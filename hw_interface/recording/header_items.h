#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/hw_interface/recording/recording.h"

namespace vmech {

/// A header but for the text of the mechanism, item by item: "device", "period", "note file",
/// "channel 0", ... Keys are unique, texts are single lines, numbers come back to the last bit.
using HeaderItems = std::vector<std::pair<std::string, std::string>>;
/// The items of a header.
HeaderItems ItemsOf(const RecordingHeader& header);

/// Takes an item as one line, "KEY TEXT". @throws std::runtime_error saying what is wrong with it.
void TakeItem(std::string_view line, RecordingHeader* header);

/// The same header with names that can stand in any format: without commas, quotes and breaks.
RecordingHeader WithPlainNames(RecordingHeader header);

}  // namespace vmech
