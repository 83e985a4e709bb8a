#include "sync/log/recorder_types.h"

#include <cstdio>

#include "lcmtypes/channels.h"
#include "lcmtypes/fields.h"

namespace tactus::sync {
namespace {

constexpr std::size_t kTitleBytes = 64;

std::vector<std::string> lines_of_types() {
  std::vector<std::string> lines;
  for (const Channel& c : channel_types())
    lines.push_back("channel " + std::string(c.name) + " " + std::string(c.type));
  for (const MessageType& t : message_types()) {
    char fingerprint[20];
    std::snprintf(fingerprint, sizeof fingerprint, "0x%016llx", static_cast<unsigned long long>(t.fingerprint));
    lines.push_back("struct " + std::string(t.name) + " " + fingerprint);
    for (const Field& f : t.fields)
      lines.push_back("  " + std::string(f.type) + " " + std::string(f.name) +
                      (f.count.empty() ? "" : "[" + std::string(f.count) + "]"));
  }
  return lines;
}

}  // namespace

std::vector<std::string> log_types() {
  std::vector<std::string> pages(1);
  for (const std::string& line : lines_of_types()) {
    if (pages.back().size() + line.size() + 1 > channels::kMaxMessageBytes - kTitleBytes) pages.emplace_back();
    pages.back() += line + "\n";
  }
  for (std::size_t i = 0; i < pages.size(); ++i)
    pages[i].insert(0,
                    "tactus types, page " + std::to_string(i + 1) + " of " + std::to_string(pages.size()) + "\n");
  return pages;
}

}  // namespace tactus::sync
