#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vmech/studies/design.h"

namespace vmech {

/// The designs that a search has looked at, in DIR/search.json, so that one that was interrupted
/// goes on. After every design the file is written anew and put in its place in one step: a kill
/// loses at most the design that was being computed.
class SearchState {
 public:
  /// Reads what is there; `question` is all that a search depends on. A folder that is not there
  /// holds nothing.
  /// @throws FileErrors if the search there is of another question, or the file is damaged.
  SearchState(std::filesystem::path folder, const std::string& question);

  const std::vector<EvaluatedDesign>& designs() const { return designs_; }
  /// @throws FileErrors if it cannot be written.
  void Add(const EvaluatedDesign& design);
  /// Forgets all: the search has ended.
  void Remove();

  static constexpr const char* kFileName = "search.json";

 private:
  void Read(const std::string& text);

  std::filesystem::path folder_;
  std::string digest_;
  std::vector<EvaluatedDesign> designs_;
};

}  // namespace vmech
