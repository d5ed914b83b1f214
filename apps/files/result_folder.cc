#include "vmech/apps/files/result_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <iterator>
#include <system_error>
#include <tuple>
#include <utility>

#include "vmech/apps/files/output_folder.h"
#include "vmech/apps/files/write_whole.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

namespace fs = std::filesystem;

struct KindOfResult {
  const char* command;
  /// The set that is replaced as a whole; no set, not even a part of one, is without the first.
  std::vector<std::string> files;
  const char* journal;  ///< stays and grows; null if there is none
};

const KindOfResult& Describe(ResultKind kind) {
  static const KindOfResult kKinds[] = {
      {"vmech loads",
       {"loads.csv", "motion.csv", "joints.csv", "certainty.csv", "bearings.csv", "summary.json",
        "report.html"},
       nullptr},
      {"vmech simulate",
       {"energies.csv", "events.csv", "loads.csv", "motion.csv", "joints.csv", "certainty.csv",
        "bearings.csv", "summary.json", "report.html"},
       nullptr},
      {"vmech compare", {"results.csv", "summary.json", "report.html"}, "rows.jsonl"},
      {"vmech sensitivities", {"sensitivities.csv", "report.html"}, nullptr},
      {"vmech optimise", {"design.csv", "mechanism.yaml", "report.html"}, nullptr},
  };
  return kKinds[static_cast<int>(kind)];
}

bool Holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

[[noreturn]] void Throw(const fs::path& path, const std::error_code& why) {
  throw FileErrors(path.string(),
                   fmt::format("cannot be written: {}; give another folder with --out, or make "
                               "room",
                               why.message()));
}

[[noreturn]] void ThrowErrno(const fs::path& path) {
  Throw(path, {errno, std::generic_category()});
}

/// Does the work; what the system refuses becomes an error that names `path`.
template <typename Work>
void Naming(const fs::path& path, const Work& work) {
  try {
    work();
  } catch (const std::system_error& error) {
    Throw(path, error.code());
  }
}

/// Is there anything at a path? A link that leads nowhere is.
bool Exists(const fs::path& path) {
  return fs::symlink_status(path).type() != fs::file_type::not_found;
}

struct stat StatusOf(const fs::path& path) {
  struct stat status = {};
  if (lstat(path.c_str(), &status) != 0) ThrowErrno(path);
  return status;
}

bool SameFile(const fs::path& a, const fs::path& b) {
  if (!Exists(a) || !Exists(b)) return false;
  const struct stat at_a = StatusOf(a), at_b = StatusOf(b);
  return at_a.st_dev == at_b.st_dev && at_a.st_ino == at_b.st_ino;
}

bool IsNewer(const fs::path& a, const fs::path& b) {
  const timespec at_a = StatusOf(a).st_mtim, at_b = StatusOf(b).st_mtim;
  return std::pair(at_a.tv_sec, at_a.tv_nsec) > std::pair(at_b.tv_sec, at_b.tv_nsec);
}

/// A number of the mount that a folder is on; 0 if it is not known.
uint64_t MountOf(const fs::path& folder) {
  struct statx status = {};
  if (statx(AT_FDCWD, folder.c_str(), 0, STATX_MNT_ID, &status) != 0) return 0;
  return (status.stx_mask & STATX_MNT_ID) != 0 ? status.stx_mnt_id : 0;
}

bool IsCurrentOrAbove(const fs::path& folder) {
  const fs::path here = fs::current_path();
  return std::mismatch(folder.begin(), folder.end(), here.begin(), here.end()).first ==
         folder.end();
}

/// Can the folder be swapped with one beside it?
bool CanSwap(const fs::path& folder) {
  if (!fs::exists(folder)) return true;
  const fs::path parent = folder.parent_path();
  return !IsCurrentOrAbove(folder) && MountOf(folder) == MountOf(parent) &&
         faccessat(AT_FDCWD, parent.c_str(), W_OK | X_OK, AT_EACCESS) == 0;
}

fs::path StageBeside(const fs::path& folder) {
  return folder.string() + kUnfinished;
}

fs::path StageInside(const fs::path& folder) {
  return folder / (std::string("new") + kUnfinished);
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder, ResultKind kind)
    : folder_(std::move(folder)), kind_(kind) {
  const InterruptsWait whole;
  try {
    Naming(folder_, [this] {
      target_ = fs::weakly_canonical(fs::absolute(folder_));
      if (!target_.has_filename()) target_ = target_.parent_path();
      if (fs::exists(target_) && !fs::is_directory(target_)) {
        throw FileErrors(folder_.string(), "is a file; give a folder with --out");
      }
      const bool now = Describe(kind_).journal != nullptr;
      MakeFolders(now ? target_ : target_.parent_path());
      LockTarget();
      RefuseOthers();
      OpenStage();
      CleanUpOnInterrupt();
    });
  } catch (...) {
    for (auto made = made_.rbegin(); made != made_.rend(); ++made) rmdir(made->c_str());
    throw;
  }
}

ResultFolder::~ResultFolder() {
  try {
    if (!committed_) RemoveStage();
  } catch (const std::exception&) {  // The next run tries again.
  }
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) rmdir(made->c_str());
}

/// Makes a folder and those above it that are not there.
void ResultFolder::MakeFolders(fs::path folder) {
  std::vector<fs::path> missing;
  for (; !fs::exists(folder); folder = folder.parent_path()) missing.push_back(folder);
  for (auto next = missing.rbegin(); next != missing.rend(); ++next) {
    if (fs::create_directory(*next)) made_.push_back(*next);
  }
}

void ResultFolder::LockTarget() {
  if (target_lock_.held() || !fs::exists(target_)) return;
  target_lock_ = PathLock(target_, O_RDONLY | O_DIRECTORY, folder_);
}

/// Nothing is replaced that is not a result of the same kind.
void ResultFolder::RefuseOthers() const {
  const KindOfResult& mine = Describe(kind_);
  for (const ResultKind other :
       {ResultKind::kLoads, ResultKind::kSimulation, ResultKind::kComparison,
        ResultKind::kSensitivities, ResultKind::kDesign}) {
    if (other == kind_) continue;
    const KindOfResult& kind = Describe(other);
    // A simulation's set holds one of loads.
    if (kind_ == ResultKind::kSimulation && other == ResultKind::kLoads &&
        Exists(target_ / mine.files[0])) {
      continue;
    }
    const std::string sign = kind.journal != nullptr ? kind.journal : kind.files[0];
    if (!Exists(target_ / sign)) continue;
    throw FileErrors(folder_.string(),
                     fmt::format("holds a result of `{}` ({}), which must not be mixed with one of "
                                 "`{}`; give another folder with --out",
                                 kind.command, sign, mine.command));
  }
  if (Exists(target_ / mine.files[0])) return;
  for (const std::string& name : mine.files) {
    if (!Exists(target_ / name)) continue;
    throw FileErrors((folder_ / name).string(),
                     fmt::format("would be overwritten, and is not of a result of `{}`, as there "
                                 "is no {} beside it; move it, or give another folder with --out",
                                 mine.command, mine.files[0]));
  }
}

/// Makes the folder in which the files are written; what a killed run has left there is returned.
void ResultFolder::OpenStage() {
  const fs::path beside = StageBeside(target_), inside = StageInside(target_);
  stage_ = CanSwap(target_) ? beside : inside;
  if (const fs::path& other = stage_ == beside ? inside : beside; Exists(other)) {
    const PathLock lock = LockStage(other);
    ReturnFrom(other);
    fs::remove(other);
  }
  if (mkdir(stage_.c_str(), 0777) != 0 && errno != EEXIST) ThrowErrno(folder_);
  stage_lock_ = LockStage(stage_);
  ReturnFrom(stage_);
}

void ResultFolder::CleanUpOnInterrupt() {
  std::vector<fs::path> files, folders{stage_};
  for (const std::string& name : Describe(kind_).files) files.push_back(stage_ / name);
  folders.insert(folders.end(), made_.rbegin(), made_.rend());
  on_interrupt_ = std::make_unique<InterruptCleanup>(files, folders);
}

PathLock ResultFolder::LockStage(const fs::path& stage) const {
  PathLock lock;
  Naming(stage, [&] { lock = PathLock(stage, O_RDONLY | O_DIRECTORY | O_NOFOLLOW, folder_); });
  return lock;
}

bool ResultFolder::IsOurs(const std::string& name) const {
  return Holds(Describe(kind_).files, name);
}

/// Empties a folder that is no longer needed; what others have put there goes to the result.
void ResultFolder::ReturnFrom(const fs::path& stage) const {
  const std::vector<fs::directory_entry> entries(fs::directory_iterator(stage), {});
  for (const fs::directory_entry& entry : entries) ReturnEntry(entry.path());
}

/// Of two files of others with one name the newer one stays.
void ResultFolder::ReturnEntry(const fs::path& entry) const {
  const fs::path place = target_ / entry.filename();
  if (IsOurs(entry.filename().string()) || SameFile(entry, place)) {
    fs::remove(entry);
  } else if (!Exists(place)) {
    fs::rename(entry, place);
  } else if (S_ISDIR(StatusOf(entry).st_mode) || S_ISDIR(StatusOf(place).st_mode)) {
    throw FileErrors(entry.string(), fmt::format("is left over, and {} is there too; keep one of "
                                                 "them and run the command again",
                                                 place.string()));
  } else if (IsNewer(entry, place)) {
    fs::rename(entry, place);
  } else {
    fs::remove(entry);
  }
}

void ResultFolder::Write(const std::string& name, const std::string& text) {
  assert(IsOurs(name));
  Naming(folder_ / name, [&] {
    if (fs::is_directory(target_ / name)) {
      throw std::system_error(std::make_error_code(std::errc::is_a_directory));
    }
    const PathLock file(stage_ / name, O_WRONLY | O_CREAT | O_EXCL, folder_ / name);
    WriteWhole(file.file(), text);
    written_.push_back(name);
  });
}

void ResultFolder::Commit() {
  const InterruptsWait whole;
  Naming(folder_, [this] {
    LockTarget();  // if it was made meanwhile
    if (!Swap()) PutInPlace();
    committed_ = true;
    on_interrupt_.reset();
  });
}

/// Puts all files of others beside the new ones; false if the file system cannot do that.
bool ResultFolder::LinkOtherFiles() const {
  for (const fs::directory_entry& entry : fs::directory_iterator(target_)) {
    const std::string name = entry.path().filename().string();
    if (IsOurs(name) || S_ISDIR(StatusOf(entry.path()).st_mode)) continue;
    if (link(entry.path().c_str(), (stage_ / name).c_str()) != 0) return false;
  }
  return true;
}

/// False if it is not possible here.
bool ResultFolder::Swap() {
  if (stage_ != StageBeside(target_)) return false;
  if (!fs::exists(target_)) {
    fs::rename(stage_, target_);
    return true;
  }
  if (!LinkOtherFiles()) return false;
  const struct stat old = StatusOf(target_);
  if (fchmod(stage_lock_.file(), old.st_mode & 07777) != 0) ThrowErrno(stage_);
  std::ignore = fchown(stage_lock_.file(), old.st_uid, old.st_gid);  // if this user may
  if (renameat2(AT_FDCWD, stage_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0) {
    const int known[] = {EINVAL, ENOSYS, EOPNOTSUPP, EXDEV, EBUSY};  // not on this file system
    if (std::find(std::begin(known), std::end(known), errno) != std::end(known)) return false;
    ThrowErrno(folder_);
  }
  RemoveStage();
  return true;
}

/// The old set goes first, so that at no time there are files of both.
void ResultFolder::PutInPlace() {
  std::vector<std::string> files = Describe(kind_).files;
  std::reverse(files.begin(), files.end());
  for (const std::string& name : files) fs::remove(target_ / name);
  for (const std::string& name : written_) fs::rename(stage_ / name, target_ / name);
  RemoveStage();
}

void ResultFolder::RemoveStage() const {
  ReturnFrom(stage_);
  fs::remove(stage_);
}

}  // namespace vmech
