// Joins the source of a chapter and the results of its run into a page.

#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "chapter.h"
#include "chapter_style.h"
#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/style.h"

namespace {

std::string ReadFile(const char* name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) throw std::runtime_error(fmt::format("cannot read '{}'", name));
  return {std::istreambuf_iterator<char>(file), {}};
}

void Render(const char* source, const char* results, const char* page) {
  const std::vector<vmech::Cell> cells = vmech::SplitIntoCells(ReadFile(source));
  const vmech::html::Markup body =
      vmech::html::Element("p", "vmech in chapters", "eyebrow") +
      vmech::RenderChapter(cells, vmech::ParseOutputs(ReadFile(results)));
  std::ofstream file(page, std::ios::binary);
  file << vmech::html::RenderPage(
      vmech::TitleOf(cells), body,
      std::string(vmech::plot::PlotStyleSheet()) + std::string(vmech::kChapterStyle));
  if (!file.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", page));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: render SOURCE RESULTS PAGE\n");
    return 2;
  }
  try {
    Render(argv[1], argv[2], argv[3]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", argv[1], error.what());
    return 1;
  }
  return 0;
}
