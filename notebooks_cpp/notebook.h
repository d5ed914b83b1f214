#pragma once

#include <cstdio>
#include <memory>
#include <source_location>
#include <string>
#include <string_view>

#include "vmech/apps/html/markup.h"
#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/polar_plot.h"

namespace vmech {

/// Where a chapter puts its results. A chapter is an ordinary program; every call remembers the
/// line it was made from, so that chapter.py can set each result under the cell it belongs to.
class Notebook {
 public:
  using Where = std::source_location;

  /// With a file name as the program's argument all results go into that file for chapter.py;
  /// without, texts and checks go to standard output and drawings are left out.
  /// The file appears whole, at the end of the chapter, or not at all.
  /// @throws std::runtime_error if the file cannot be written.
  Notebook(int argc, char** argv);
  ~Notebook();
  Notebook(const Notebook&) = delete;
  Notebook& operator=(const Notebook&) = delete;

  void Print(std::string_view text, Where where = Where::current());
  void Show(const html::Table& table, Where where = Where::current());
  void Show(const plot::LinePlot& plot, Where where = Where::current());
  void Show(const plot::PolarPlot& plot, Where where = Where::current());

  /// A claim of the chapter. One that does not hold makes the chapter fail.
  void Check(std::string_view claim, bool holds, Where where = Where::current());
  /// |value - expected| <= tolerance; all three are shown with the claim.
  void CheckNear(std::string_view claim, double value, double expected, double tolerance,
                 Where where = Where::current());

  /// What main returns: 0 if every claim held.
  int ExitCode() const { return failures_ == 0 ? 0 : 1; }

 private:
  void Write(std::string_view kind, std::string_view content, const Where& where);

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string results_, unfinished_;  // the file's name, and that until it is whole
  std::unique_ptr<std::FILE, Close> file_;
  int failures_ = 0;
};

}  // namespace vmech
