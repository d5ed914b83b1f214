#pragma once

namespace vmech {

/// Puts PrintableText between this program and its standard output and standard error, once and for
/// all that it prints: names out of files, devices and libraries' messages cannot act on a
/// terminal. What is meant to act, as ProgressBar, writes to the file descriptor.
void PrintOnlyPrintableText();

}  // namespace vmech
