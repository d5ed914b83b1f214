#include "vmech/apps/console/printable_streams.h"

#include <unistd.h>
#include <ext/stdio_sync_filebuf.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <string>

#include "vmech/base/text/printable_text.h"

namespace vmech {
namespace {

/// One of the two streams.
struct PrintableStream {
  int file;
  std::string begun;  ///< a character whose other bytes are still to come
};

bool WriteAll(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    text.remove_prefix(static_cast<size_t>(count));
  }
  return true;
}

/// As fopencookie(3) wants it: 0 if nothing can be written.
ssize_t Write(void* cookie, const char* text, size_t size) {
  PrintableStream& stream = *static_cast<PrintableStream*>(cookie);
  stream.begun.append(text, size);
  std::string shown;
  stream.begun.erase(0, AppendPrintable(stream.begun, &shown));
  return WriteAll(stream.file, shown) ? static_cast<ssize_t>(size) : 0;
}

FILE* Open(PrintableStream* stream, int buffering) {
  FILE* file = fopencookie(stream, "w", {nullptr, Write, nullptr, nullptr});
  if (file != nullptr) setvbuf(file, nullptr, buffering, BUFSIZ);
  return file;
}

/// Sends a stream of C++ after the one of C.
void Follow(std::ostream* stream, FILE* file) {
  using Buffer = __gnu_cxx::stdio_sync_filebuf<char>;
  stream->rdbuf(new Buffer(file));  // NOLINT: lives as long as the program prints
}

}  // namespace

void PrintOnlyPrintableText() {
  static PrintableStream out{STDOUT_FILENO, {}}, err{STDERR_FILENO, {}};
  FILE* const new_out = Open(&out, isatty(STDOUT_FILENO) == 1 ? _IOLBF : _IOFBF);
  FILE* const new_err = Open(&err, _IONBF);
  if (new_out == nullptr || new_err == nullptr) return;
  stdout = new_out;
  stderr = new_err;
  Follow(&std::cout, new_out);
  Follow(&std::cerr, new_err);
}

}  // namespace vmech
