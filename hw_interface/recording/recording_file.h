#pragma once

#include <filesystem>
#include <memory>

#include "vmech/hw_interface/recording/recording.h"
#include "vmech/hw_interface/recording/recording_writer.h"

namespace vmech {

/// MCAP if the name ends in .mcap, else CSV.
std::unique_ptr<RecordingWriter> MakeRecordingWriter(const std::filesystem::path& file,
                                                     const RecordingHeader& header);

/// In format 2, docs/recording-format.md: MCAP if the name ends in .mcap, else CSV.
/// @throws std::runtime_error if the file cannot be written.
void WriteRecording(const std::filesystem::path& file, const Recording& recording);

/// How much of a recording is read.
enum class RecordingPart {
  kWhole,
  kSamples,  ///< without `picture` and `channels`: for a replay, which finds them anew
};

/// @throws std::runtime_error with file:line (of MCAP: file, byte), what is wrong there and what
/// was expected.
Recording ReadRecording(const std::filesystem::path& file,
                        RecordingPart part = RecordingPart::kWhole);

}  // namespace vmech
