#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "vmech/apps/files/interrupt_cleanup.h"
#include "vmech/apps/files/path_lock.h"

namespace vmech {

/// What a result folder holds.
enum class ResultKind { kLoads, kSimulation, kComparison, kSensitivities, kDesign };

/// The folder of a result. Its files are written into another one beside it,
/// `<folder>.vmech-unfinished`, and the two are swapped in one step (renameat2,
/// RENAME_EXCHANGE): killed at any moment, a run leaves the old set of files or the new one, and at
/// most the other folder, which goes with the next run into the same one. From its construction to
/// its end no other process can write the folder.
///
/// What others have put into the folder stays there: files are in both folders (hard links) before
/// these are swapped, sub-folders are carried over right after.
///
/// Where a swap is not possible - the folder is the current one or above it, the root of a mount,
/// its parent cannot be written, or the file system knows neither exchange nor hard links - the
/// files are written into a sub-folder (or beside), then the old set is removed, then the new files
/// are moved into their places: killed then, a run leaves part of the new set, never parts of both.
class ResultFolder {
 public:
  /// Makes what is needed of the folders above. A comparison's folder is made too: its journal is
  /// kept there from the start.
  /// @throws FileErrors if that cannot be done, if another process is writing the folder, if it
  ///         holds a result of another kind, or files under the names of this one that are none.
  ResultFolder(std::filesystem::path folder, ResultKind kind);
  /// Removes what was not committed, and folders made for it; so does an interruption (Ctrl-C).
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// `name`: one of the kind's files, the tables first. @throws FileErrors if it cannot be written.
  void Write(const std::string& name, const std::string& text);
  /// Puts all files in their places. @throws FileErrors if that cannot be done.
  void Commit();

  /// As it was given.
  const std::filesystem::path& path() const { return folder_; }

 private:
  void MakeFolders(std::filesystem::path folder);
  void LockTarget();
  void RefuseOthers() const;
  void OpenStage();
  void CleanUpOnInterrupt();
  PathLock LockStage(const std::filesystem::path& stage) const;
  void ReturnFrom(const std::filesystem::path& stage) const;
  void ReturnEntry(const std::filesystem::path& entry) const;
  bool LinkOtherFiles() const;
  bool Swap();
  void PutInPlace();
  void RemoveStage() const;
  bool IsOurs(const std::string& name) const;

  std::filesystem::path folder_, target_, stage_;
  ResultKind kind_;
  std::vector<std::filesystem::path> made_;  ///< outermost first
  PathLock target_lock_, stage_lock_;
  std::vector<std::string> written_;
  bool committed_ = false;
  std::unique_ptr<InterruptCleanup> on_interrupt_;
};

}  // namespace vmech
