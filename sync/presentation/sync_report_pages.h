// Writes SYNC_REPORT in pages that fit a datagram, and reassembles them. Pure.
#pragma once

#include <optional>
#include <tactus/sync_report_t.hpp>
#include <vector>

#include "lcmtypes/page_limits.h"
#include "sync/bus/page_assembler.h"
#include "sync/presentation/presentation_matcher.h"

namespace tactus::sync {

// The results so far, with unstamped headers: publish the pages in order. An entry whose name alone is too long for a page is
// left out.
std::vector<sync_report_t> report_pages(const PresentationMatcher& matcher);

// Reassembles pages into whole reports.
class SyncReportReader {
 public:
  // Returns the report as one page once its last page has arrived. Pages have consecutive numbers; pages of an older report
  // are dropped.
  std::optional<sync_report_t> push(const sync_report_t& page);

 private:
  std::int64_t incarnation_ = 0, first_seq_ = -1;
  PageAssembler<sync_report_t, std::int64_t> pages_{{.groups = 1, .pages = kMaxReportPages}};  // by the number of the first page
};

}  // namespace tactus::sync
