// Any bytes, read as a log: the scanner ends, and never stands before where it stood.
#include <cstdlib>

#include "sync/log_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tactus::sync::LogScanner scanner({data, size});
  tactus::sync::LogEvent event;
  std::size_t at = 0;
  while (scanner.next(event)) {
    if (scanner.at() <= at || scanner.at() > size) std::abort();
    at = scanner.at();
  }
  if (scanner.damaged_bytes() < 0 || scanner.damaged_bytes() > static_cast<std::int64_t>(size)) std::abort();
  return 0;
}
